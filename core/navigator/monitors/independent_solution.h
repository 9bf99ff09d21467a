// IndependentSolution is a point solution of one epoch, computed without the filter, against which
// the filter is tested.
#pragma once
#include <Eigen/Core>

#include "core/gnss/measurement/measurement.h"
#include "core/gnss/positioning/point_solution.h"

namespace leonav {

// The solution with the measurements that it used.
struct IndependentSolution {
  PointSolution point;
  bool accepted = false;  // satellites, PDOP and residuals suffice to start a filter from it
  // The epoch's measurements with the reasons from this solution; valid until the next solution is
  // computed.
  const MeasurementEpoch* measurements = nullptr;
};

// IndependentSolver computes the solution of the current epoch when a test needs it. Each call may
// update the receiver's code biases. A test therefore calls it only if its verdict depends on the
// solution.
class IndependentSolver {
 public:
  virtual ~IndependentSolver() = default;
  // Solves the epoch; `approximate_p_e` is the antenna's approximate position, ECEF, m; zero:
  // unknown.
  virtual IndependentSolution solve(const Eigen::Vector3d& approximate_p_e) = 0;
};

// Smallest redundancy of a point solution that may replace a running filter.
inline constexpr int kMinResetRedundancy = 2;

// Returns whether at least two thirds of the codes are used. A few codes always agree on some
// position; only a majority is more than chance.
bool most_codes_agree(const MeasurementEpoch& epoch);

// Returns whether no code is an outlier and at most a fifth of the used codes is downweighted.
bool all_codes_agree(const MeasurementEpoch& epoch);

// Returns whether the redundancy is at least kMinResetRedundancy, and at least three times the
// number of outliers among the codes and among the Dopplers.
bool is_highly_redundant(const IndependentSolution& solution);

}  // namespace leonav
