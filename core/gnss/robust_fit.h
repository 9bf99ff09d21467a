// Least squares over scalar measurements with few unknowns, robust against gross errors: an L1
// start, then IGG-III, then data snooping. Fixed size: normal equations are accumulated row by row.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/capacity.h"
#include "core/gnss/igg3.h"

namespace leonav {

// Three geometric unknowns (position or velocity), then one clock unknown per group of rows.
inline constexpr int kFitUnknowns = 3 + static_cast<int>(kMaxTimeBases);
using FitState = Eigen::Matrix<double, kFitUnknowns, 1>;
using FitMatrix = Eigen::Matrix<double, kFitUnknowns, kFitUnknowns>;

struct FitRow {
  std::size_t source = 0;  // the caller's index
  int group = 0;           // clock unknown 3 + group
  int satellite = 0;       // several rows of one satellite count once
  double sigma = 1.0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // d prediction / d geometric unknowns
  double residual = 0.0;  // measured minus predicted at the state last linearized
  double factor = 1.0;    // on the weight 1 / sigma^2; 0: out
  bool excluded = false;  // by data snooping, for good
  bool alone = false;     // its group has no second satellite: it tells its clock and nothing else
};
using FitRows = boost::container::static_vector<FitRow, kMaxMeasurements>;

// Predicts the rows.
class FitModel {
 public:
  virtual ~FitModel() = default;
  // Sets direction and residual of every row at `state`.
  virtual void linearize(const FitState& state, FitRows* rows) const = 0;
};

enum class FitStatus : unsigned char {
  kOk,
  kTooFewRows,
  kSingular,
  kNotConverged,
  kFaulty,  // a gross error is there, but too few rows are left to tell whose
};

struct FitResult {
  FitStatus status = FitStatus::kTooFewRows;
  FitMatrix covariance = FitMatrix::Zero();  // times scale^2; unused clocks: meaningless
  // Robust scatter of residual over sigma, at least 1 and at most kMaxFitScale: where all sigmas
  // are too small the tests and the covariance follow the data.
  double scale = 1.0;
  int redundancy = 0;  // rows in use minus unknowns
};
inline constexpr double kMaxFitScale = 4.0;

// Improves `*state` and leaves in `*rows` the factors and the residuals of the result. A group with
// a single satellite takes no part. With robust.enabled false: plain weighted least squares.
FitResult robust_fit(const FitModel& model, const RobustConfig& robust, FitState* state,
                     FitRows* rows);

}  // namespace leonav
