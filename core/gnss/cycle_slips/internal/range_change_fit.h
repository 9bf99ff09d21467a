// This unit fits a set of a range change's rows by least squares and compares each row with the
// result.
#pragma once
#include <Eigen/Core>
#include <array>

#include "core/gnss/cycle_slips/internal/range_change_rows.h"

namespace leonav {

// Result of one fit, in units of the priors.
struct ChangeFit {
  using Matrix = Eigen::Matrix<double, kChangeUnknowns, kChangeUnknowns>;
  ChangeVector state = ChangeVector::Zero();
  // Inverse covariance: lower * diag(1 / inverse_pivots) * lower^T.
  Matrix lower;  // below the diagonal, which is 1
  ChangeVector inverse_pivots;
  double scale = 1.0;  // of the rows' sigmas
};

// Deviation of a row from the prediction by the other rows.
struct ExternalDeviation {
  double value_m = 0.0, sigma_m = 0.0;  // sigma 0: no other row checks it
  double standardized() const;
};

// ChangeFitter fits subsets of the rows of one epoch.
class ChangeFitter {
 public:
  // `rows` must outlive the fitter.
  ChangeFitter(const ChangeRows& rows, const CycleSlipConfig& config);

  std::size_t size() const { return rows_.rows.size(); }
  ChangeSet all() const;
  ChangeFit fit(const ChangeSet& kept, double scale) const;
  ExternalDeviation external(std::size_t i, const ChangeFit& fit, bool kept) const;
  // Returns the rows whose external deviation from `fit`, a fit of the rows `kept`, is within the
  // limit.
  ChangeSet agreeing(const ChangeSet& kept, const ChangeFit& fit) const;
  // Returns the half of the rows, plus `more`, that deviate least in their sigmas.
  ChangeSet nearest_half(const ChangeFit& fit, std::size_t more) const;
  // Returns the sum of the squares of the kept rows plus the squared limit for each other row.
  double cost(const ChangeSet& kept, const ChangeFit& fit) const;
  // Returns the number of unknowns that the rows, not their priors, determine where a cycle
  // matters: a prior of centimetres leaves nothing to determine.
  double parameters(const ChangeSet& kept) const;
  // Returns the root mean square of the kept rows' deviations over their sigmas; 0 with too few
  // spare rows.
  double scatter(const ChangeSet& kept, double scale) const;

 private:
  // Rows are stored side by side, so that several are computed at once.
  static constexpr std::size_t kLanes = 8, kBlocks = (kMaxSatellites + kLanes - 1) / kLanes;
  using Lanes = Eigen::Array<double, kLanes, 1>;
  struct Block {
    std::array<Lanes, kChangeUnknowns> h;
    Lanes residual, variance;
  };
  double deviation(const ChangeRow& row, const ChangeFit& fit) const {
    return row.residual - row.h.dot(fit.state);
  }
  void factorize(ChangeFit* fit) const;

  const ChangeRows& rows_;
  const CycleSlipConfig& config_;
  boost::container::static_vector<Block, kBlocks> blocks_;
};

}  // namespace leonav
