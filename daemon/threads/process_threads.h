// These functions find the threads of this process, and schedule them.
#pragma once
#include <sys/types.h>

#include <set>
#include <string>

#include "daemon/config/daemon_config.h"

namespace leonav {

// Returns the threads of this process; empty where /proc cannot be read.
std::set<pid_t> threads_of_process();

// Gives a thread its processor and its priority. Returns the settings that the system refused, as a
// text; empty: none. `name`: for that text.
std::string schedule(pid_t thread, const std::string& name, const ThreadConfig& config);

}  // namespace leonav
