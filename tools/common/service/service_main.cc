#include "tools/common/service/service_main.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstddef>
#include <cstring>
#include <exception>
#include <new>
#include <string>
#include <tuple>

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

const char* text_of(const std::exception& error) {
  if (dynamic_cast<const std::bad_alloc*>(&error) != nullptr)
    return "out of memory: give it more (MemoryMax= and LimitAS= of its unit, ulimit -v), or leave "
           "it more on this machine";
  return error.what();
}

void write_text(const char* text) { std::ignore = write(STDERR_FILENO, text, std::strlen(text)); }

// Memory may be short, so nothing here allocates. Destructors would wait for threads that may wait
// for this one.
[[noreturn]] void end_at_once() {
  char thread[16] = {};
  prctl(PR_GET_NAME, thread);
  write_text("error: thread ");
  write_text(thread);
  write_text(": ");
  try {
    if (const auto error = std::current_exception()) std::rethrow_exception(error);
  } catch (const std::exception& error) {
    write_text(text_of(error));
  } catch (...) {
    write_text("ended without a reason");
  }
  write_text("\n");
  _exit(kExitFailure);
}

// A stack that cannot grow kills the program without a word. So the memory that the first functions
// need is asked for in a way that can be refused.
void require_memory_to_begin() {
  constexpr std::size_t kLeast_bytes = 4U << 20U;
  void* const place =
      mmap(nullptr, kLeast_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (place == MAP_FAILED) throw std::bad_alloc();
  munmap(place, kLeast_bytes);
}

}  // namespace

int service_main(const char* name, int argc, char** argv, int (*body)(int argc, char** argv)) {
  std::set_terminate(end_at_once);
  require_memory_to_begin();
  spdlog::set_default_logger(spdlog::stderr_logger_mt(name));
  spdlog::set_pattern(std::string(name) + " %H:%M:%S.%e %l: %v");
  try {
    return body(argc, argv);
  } catch (const std::exception& error) {
    spdlog::error("{}", text_of(error));
    return exit_code_of(error);
  }
}

}  // namespace leonav
