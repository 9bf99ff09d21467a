#include "tools/common/service/service_main.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <exception>
#include <string>

#include "daemon/config/load_config.h"
#include "daemon/link/open_lcm.h"
#include "drivers/lcm/event_log.h"
#include "tools/common/arguments.h"

namespace leonav {
namespace {

int exit_code_of(const std::exception& error) {
  if (dynamic_cast<const UsageError*>(&error) != nullptr) return kExitUsage;
  if (dynamic_cast<const ConfigError*>(&error) != nullptr) return kExitConfig;
  if (dynamic_cast<const LcmError*>(&error) != nullptr) return kExitLcm;
  if (dynamic_cast<const EventLogError*>(&error) != nullptr) return kExitJournal;
  return kExitFailure;
}

}  // namespace

int service_main(const char* name, int argc, char** argv, int (*body)(int argc, char** argv)) {
  spdlog::set_default_logger(spdlog::stderr_logger_mt(name));
  spdlog::set_pattern(std::string(name) + " %H:%M:%S.%e %l: %v");
  try {
    return body(argc, argv);
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return exit_code_of(error);
  }
}

}  // namespace leonav
