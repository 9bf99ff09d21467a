// This function checks the configuration of a journal that is to be written.
#pragma once
#include "daemon/config/daemon_config.h"

namespace leonav {

// Throws ConfigError where the path cannot be a journal's, or where pieces would hold next to
// nothing; each of the two is a line with key and remedy. Only what writes a journal asks for it: a
// replay takes the configuration of any journal as it is.
void require_journal(const DaemonConfig& config);

}  // namespace leonav
