#include "tools/common/service/service_main.h"

#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <unistd.h>

#include <cstddef>
#include <exception>
#include <memory>
#include <new>
#include <string>

#include "daemon/config/load_config.h"
#include "daemon/link/open_lcm.h"
#include "daemon/log/descriptor_write.h"
#include "daemon/log/log_thread.h"
#include "drivers/lcm/event_log.h"
#include "tools/common/arguments.h"
#include "tools/common/service/log_sink.h"

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

// Of the process; made before anything is logged.
std::shared_ptr<LogThread> log_thread;

// An end must come, whether somebody reads or not.
void write_text(const char* text) {
  constexpr int kLongest_ms = 200;
  write_where_there_is_room(STDERR_FILENO, text, kLongest_ms);
}

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
  log_thread = std::make_shared<LogThread>(STDERR_FILENO, name);
  spdlog::set_default_logger(
      std::make_shared<spdlog::logger>(name, std::make_shared<LogSink>(log_thread)));
  spdlog::set_pattern(std::string(name) + " %H:%M:%S.%e %l: %v");
  int code = 0;
  try {
    code = body(argc, argv);
  } catch (const std::exception& error) {
    spdlog::error("{}", text_of(error));
    code = exit_code_of(error);
  }
  log_thread->finish();
  return code;
}

void start_log_thread() { log_thread->start(); }

}  // namespace leonav
