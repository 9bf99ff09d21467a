// Whether a long run needs more and more: memory, time, states, measurements.
#pragma once
#include <string>

#include "core/navigator/navigator_config.h"

namespace leonav {

// Streams the log through the smoother and prints a row after ten minutes of data and then every
// hour. Throws std::runtime_error where the last row's memory, time per solve, or unknowns and
// residuals per keyframe and satellite are more than the first one's by more than chance.
void measure_growth(const NavigatorConfig& config, const std::string& log_path,
                    const std::string& prefix);

}  // namespace leonav
