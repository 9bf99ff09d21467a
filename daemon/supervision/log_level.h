// This function sets the level from which on lines are logged.
#pragma once
#include "daemon/config/daemon_config.h"

namespace leonav {

void set_log_level(LogLevel level);

}  // namespace leonav
