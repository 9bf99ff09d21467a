// This function gives the time between two SOLUTION messages that a configuration asks for.
#pragma once
#include <limits>

#include "core/navigator/interface/navigator_config.h"

namespace leonav {

// s; infinite: none are published.
inline double solution_interval(const NavigatorConfig& config) {
  if (config.motion != MotionModel::kInertial) return config.realtime.epoch_interval_s;
  return config.solution_rate_hz > 0.0 ? 1.0 / config.solution_rate_hz
                                       : std::numeric_limits<double>::infinity();
}

}  // namespace leonav
