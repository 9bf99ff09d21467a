// This function sets from which level on the log tells.
#pragma once
#include "daemon/config/daemon_config.h"

namespace leonav {

void set_log_level(LogLevel level);

}  // namespace leonav
