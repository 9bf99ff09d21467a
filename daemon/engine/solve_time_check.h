// This function refuses a smoother that cannot keep its deadline on this machine.
#pragma once
#include "core/navigator/interface/navigator_config.h"

namespace leonav {

// Measures in a thread of its own, before the stages' threads are started, and logs the time. Does
// nothing where the smoother does not give the answer. Throws as require_in_time().
void check_solve_time(const NavigatorConfig& config);

}  // namespace leonav
