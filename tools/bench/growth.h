// Whether a long run needs more and more: memory, time, states, measurements.
#pragma once
#include <string>

#include "core/navigator/navigator_config.h"

namespace leonav {

// Streams the log through the smoother and prints a row after ten minutes of data and then every
// hour. Throws std::runtime_error where the last rows' memory, keyframes, unknowns, residual blocks
// or time per solve are more than the first ones' by more than chance.
void measure_growth(const NavigatorConfig& config, const std::string& log_path,
                    const std::string& prefix);

}  // namespace leonav
