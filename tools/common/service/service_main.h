// The programs that run beside each other as services start and end alike.
#pragma once

namespace leonav {

// Exit codes of the services, as their --help tells them.
inline constexpr int kExitFailure = 1, kExitUsage = 2, kExitConfig = 3, kExitLcm = 4,
                     kExitJournal = 5;

// Logs to standard error under the program's `name` and returns what `body` returns. Of an
// exception it logs the text and returns the exit code of its kind: UsageError, ConfigError,
// LcmError, EventLogError, else kExitFailure. An exception that nobody catches, in any thread, ends
// the process at once, with its text and kExitFailure: what is on the disk by then remains.
//
// Where nobody reads standard error, the log costs no more than a moment, at the end two seconds;
// lines are lost then, and counted.
int service_main(const char* name, int argc, char** argv, int (*body)(int argc, char** argv));

// For `body`, where not even a moment may be lost: from here on a thread of its own (LogThread)
// writes the log.
void start_log_thread();

}  // namespace leonav
