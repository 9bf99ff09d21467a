// Least squares over a set of a range change's rows, and how each row stands to the result.
#pragma once
#include <Eigen/Core>
#include <array>

#include "core/gnss/range_change_rows.h"

namespace leonav {

struct ChangeFit {
  using Matrix = Eigen::Matrix<double, kChangeUnknowns, kChangeUnknowns>;
  ChangeVector state = ChangeVector::Zero();
  // Inverse covariance: lower * diag(1 / inverse_pivots) * lower^T.
  Matrix lower;  // below the diagonal, which is 1
  ChangeVector inverse_pivots;
  double scale = 1.0;  // of the rows' sigmas
};

// Of a row's deviation from what the others say.
struct ExternalDeviation {
  double value_m = 0.0, sigma_m = 0.0;  // sigma 0: nothing checks it
  double standardized() const;
};

class ChangeFitter {
 public:
  // `rows` must outlive it.
  ChangeFitter(const ChangeRows& rows, const CycleSlipConfig& config);

  std::size_t size() const { return rows_.rows.size(); }
  ChangeSet all() const;
  ChangeFit fit(const ChangeSet& kept, double scale) const;
  ExternalDeviation external(std::size_t i, const ChangeFit& fit, bool kept) const;
  // The rows whose external deviation from `fit`, of the rows `kept`, is within the limit.
  ChangeSet agreeing(const ChangeSet& kept, const ChangeFit& fit) const;
  // The half of the rows, and some `more`, that deviate least in their sigmas.
  ChangeSet nearest_half(const ChangeFit& fit, std::size_t more) const;
  // Sum of squares of what is kept, and of the limit for what is not.
  double cost(const ChangeSet& kept, const ChangeFit& fit) const;
  // Unknowns that the rows, not their priors, determine, where what matters is a cycle: a prior of
  // centimetres leaves nothing to determine.
  double parameters(const ChangeSet& kept) const;
  // Root mean square of the kept rows' deviations over their sigmas; 0 where too few are spare.
  double scatter(const ChangeSet& kept, double scale) const;

 private:
  // Rows side by side, so that the same is computed of several at once.
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
