// IndependentSolution is a point solution of one epoch, computed without the filter, against which
// the filter is tested.
#pragma once
#include <Eigen/Core>

#include "core/gnss/measurement/measurement.h"
#include "core/gnss/positioning/point_solution.h"

namespace leonav {

struct IndependentSolution {
  PointSolution point;
  bool accepted = false;  // satellites, PDOP and residuals suffice to start a filter from it
  // The epoch's measurements with the reasons that the solution gave them; valid until the next
  // solution is computed.
  const MeasurementEpoch* measurements = nullptr;
};

// Computes the solution of the epoch at hand when a test needs it. Each call may update the
// receiver's code biases, so a test calls it only where its result depends on the solution.
class IndependentSolver {
 public:
  virtual ~IndependentSolver() = default;
  // `approximate_p_e`: antenna, ECEF, m; zero: unknown.
  virtual IndependentSolution solve(const Eigen::Vector3d& approximate_p_e) = 0;
};

// Least redundancy of a point solution that overrules a running filter.
inline constexpr int kMinResetRedundancy = 2;

// Number of satellites beyond those that the position and one clock per system time need.
int redundancy(const PointSolution& point);

// At least two thirds of the codes are used. Any few codes agree with some position; only a
// majority is more than chance.
bool most_codes_agree(const MeasurementEpoch& epoch);

// No code is an outlier, and at most a fifth is downweighted.
bool all_codes_agree(const MeasurementEpoch& epoch);

// The solution has more redundancy than it needs, and much more than it has outliers among the
// codes or the Dopplers.
bool is_highly_redundant(const IndependentSolution& solution);

}  // namespace leonav
