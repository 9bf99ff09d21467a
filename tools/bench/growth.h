// This unit tests whether a long run needs more and more memory, time, states or measurements.
#pragma once
#include <string>

#include "core/navigator/interface/navigator_config.h"

namespace leonav {

// Streams the log through the smoother and prints a row after ten minutes of data and then every
// hour.
//
// Throws std::runtime_error if memory, keyframes, unknowns, residual blocks or time per solve in
// the last rows exceed those in the first rows by more than chance.
void measure_growth(const NavigatorConfig& config, const std::string& log_path,
                    const std::string& prefix);

}  // namespace leonav
