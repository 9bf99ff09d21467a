// This function measures how long a solve of the smoother takes on this machine, before the service
// depends on it.
#pragma once
#include "core/navigator/interface/navigator_config.h"

namespace leonav {

inline constexpr int kMeasuredSolves = 9;

struct SolveTime {
  int satellites = 0;    // of the measured keyframes
  int solved = 0;        // of kMeasuredSolves, those with a result
  double solve_s = 0.0;  // median of solves with one iteration, processor time
};

// Measures, in the caller's thread, solves of a full window: a vehicle that stands at zero latitude
// under as many satellites as the configured systems have in view under an open sky, at most as
// many as the configuration uses; codes and Dopplers on two frequencies, one carrier, 200 IMU
// samples a second where there is an IMU. Slips, vehicle constants and a second iteration come on
// top. Processor time does not depend on what runs beside the start; a quota of a container or of a
// hypervisor, which it does not see either, shows as missed deadlines. Allocates.
// Precondition: the configuration's estimator is the smoother.
SolveTime measure_solve_time(const NavigatorConfig& config);

// The time that a solve has, and how many iterations it makes at least.
struct TimeToSolve {
  double limit_s = 0.0;
  int iterations = 1;
};

// With an IMU it is the smoother's deadline, before which one iteration must end. Without one there
// is no deadline, and elapsed time ends no solve: all iterations must end before the next keyframe.
TimeToSolve time_to_solve(const NavigatorConfig& config);

// Throws std::runtime_error where they take more than half of that time: the filter needs some of
// it too, and a machine is not always as quick. It is no ConfigError: a processor that is throttled
// at the start is not so for ever, so that a service manager has to try again.
void require_in_time(const NavigatorConfig& config, const SolveTime& time);

}  // namespace leonav
