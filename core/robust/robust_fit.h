// This unit fits a few unknowns to scalar measurements by least squares, robustly against gross
// errors. The order is: an L1 start, then IGG-III, then data snooping. Everything has a fixed size:
// normal equations are accumulated row by row.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/base/capacity.h"
#include "core/robust/igg3.h"

namespace leonav {

// Three geometric unknowns (position or velocity) come first, then one clock unknown per group of
// rows.
inline constexpr int kFitUnknowns = 3 + static_cast<int>(kMaxSystemTimes);
using FitState = Eigen::Matrix<double, kFitUnknowns, 1>;
using FitMatrix = Eigen::Matrix<double, kFitUnknowns, kFitUnknowns>;

// One scalar measurement, linearized. Its unit, m or m/s, is that of the fit.
struct FitRow {
  std::size_t source = 0;  // the caller's index of the measurement
  int group = 0;           // the row's clock is unknown 3 + group
  int satellite = 0;       // several rows of one satellite count as one direction
  double sigma = 1.0;
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();  // d prediction / d geometric unknowns
  double residual = 0.0;  // measured minus predicted at the state last linearized
  double factor = 1.0;    // on the weight 1 / sigma^2; 0: excluded
  bool excluded = false;  // by data snooping, permanently
  bool single_in_group =
      false;  // the only satellite of its group: it determines the group's clock and nothing else

  bool in_use() const { return factor > 0.0 && !excluded && !single_in_group; }
};
using FitRows = boost::container::static_vector<FitRow, kMaxMeasurements>;

// A FitModel predicts the rows at a state.
class FitModel {
 public:
  virtual ~FitModel() = default;
  // Sets direction and residual of every row at `state`.
  virtual void linearize(const FitState& state, FitRows* rows) const = 0;
};

// Outcome of a fit; only kOk gives a usable state.
enum class FitStatus : unsigned char {
  kOk,
  kTooFewRows,
  kSingular,
  kNotConverged,
  kFaulty,  // a gross error is present, but too few rows are left to locate it
};

// Quality of a fit; the state itself is the caller's.
struct FitResult {
  FitStatus status = FitStatus::kTooFewRows;
  FitMatrix covariance = FitMatrix::Zero();  // scaled by scale^2; unused clocks: meaningless
  // Robust scatter of residual over sigma, at least 1 and at most kMaxFitScale. Where all sigmas
  // are too small, the tests and the covariance follow the data.
  double scale = 1.0;
  int redundancy = 0;  // rows in use minus unknowns
};
inline constexpr double kMaxFitScale = 4.0;

// Improves `*state` and leaves in `*rows` the factors and the residuals of the result. A group with
// a single satellite takes no part. With robust.enabled false it is plain weighted least squares.
FitResult robust_fit(const FitModel& model, const RobustConfig& robust, FitState* state,
                     FitRows* rows);

}  // namespace leonav
