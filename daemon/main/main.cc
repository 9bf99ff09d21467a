// leonavd: the navigation daemon. Exit codes: 0 stopped cleanly; 1 failure while running; 2 wrong
// command line; 3 configuration; 4 LCM or network; 5 journal.
#include <spdlog/spdlog.h>

#include <csignal>
#include <memory>
#include <optional>
#include <string>

#include "daemon/engine/drill.h"
#include "daemon/engine/engine.h"
#include "daemon/engine/saved_inputs.h"
#include "daemon/engine/solve_time_check.h"
#include "daemon/link/channel_lock.h"
#include "daemon/link/lcm_publisher.h"
#include "daemon/link/service_manager.h"
#include "daemon/main/command_line.h"
#include "daemon/process/one_blas_thread.h"
#include "daemon/process/process_signals.h"
#include "daemon/process/timely_end.h"
#include "daemon/service/lcm_link.h"
#include "daemon/service/receiving_thread.h"
#include "daemon/supervision/config_reload.h"
#include "daemon/supervision/journal_log.h"
#include "daemon/supervision/log_level.h"
#include "daemon/supervision/supervisor.h"
#include "daemon/threads/process_memory.h"
#include "tools/common/service/service_main.h"

namespace {

using namespace leonav;

// Of which the journal may take Journal::kLongestEnd_s, then the checkpoint
// CheckpointWriter::kLongestEnd_s, and the log LogThread::kLongestEnd_s. A service manager waits
// for 20 s.
constexpr unsigned kLongestEnd_s = 15;

// OpenBLAS would have started its threads by main().
__attribute__((section(".preinit_array"), used)) const auto kBeforeLibraries =
    start_with_one_blas_thread;

// Settings that the system refused, or that cannot be followed.
void warn_of(const std::string& text) {
  if (!text.empty()) spdlog::warn("{}", text);
}

// After the threads have ended. Returns the exit code.
int tell_end(Engine* engine, bool is_complete, bool io_failed, const std::string& lcm_url) {
  JournalLog::tell_kept(&engine->journal());
  if (const std::string problem = engine->checkpoint_error(); !problem.empty())
    spdlog::warn("the last checkpoint is not written: {}", problem);
  if (!is_complete) {
    spdlog::error("{}", engine->journal().error());
    return kExitJournal;
  }
  if (io_failed) {
    spdlog::error("LCM at '{}' failed while receiving", lcm_url);
    return kExitFailure;
  }
  const EngineCounters& counters = engine->counters();
  spdlog::info(
      "stopped; {} messages published, {} journaled, {} deadline misses, {} of the smoother",
      counters.published.get(), engine->journal().counters().journaled.get(), counters.misses.get(),
      counters.smoother_misses.get());
  return 0;
}

int run(const CommandLine& command_line) {
  std::signal(SIGHUP, SIG_IGN);  // until there is something to reload
  auto [config, gate] = command_line.load();
  set_log_level(config.log.level);
  prepare_memory();
  start_log_thread();
  const ChannelLock lock(config.lcm);
  check_solve_time(config.navigator);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is a failure of a write

  const ServiceManager manager;
  warn_of(manager.problem());
  LcmPublisher publisher(config.lcm);
  Engine engine(config, &publisher, drill_hooks(config));
  // Before the engine's threads are started; that of the log takes no signal. Where the start
  // fails, a signal ends what waits in ~Engine.
  std::optional<ProcessSignals> signals(std::in_place);
  LcmReceiver receiver(config.lcm, config.threads.io, &engine, gate.get());
  warn_of(receiver.refused());
  for (const std::string& refused : engine.start()) warn_of(refused);
  begin_from_saved(config.checkpoint.path, &engine);
  ReceivingThread io(&receiver, &engine);
  warn_of(io.start(config.threads.io));
  spdlog::info("running; LCM {}, channels {}*, journal {}", config.lcm.url, config.lcm.prefix,
               engine.journal().path().empty() ? "off" : engine.journal().path());
  if (!config.commands.key_file.empty())
    spdlog::info("commands: only those signed with the key of {}", config.commands.key_file);

  ConfigReload reload([command_line] { return command_line.load_again(); }, &config,
                      &engine.journal(), gate.get());
  Supervisor supervisor(&engine, config, &manager, &lock, &reload);
  manager.ready();
  supervisor.run(&*signals, io);
  manager.stopping();

  signals.reset();  // from here on a second signal kills
  end_within(kLongestEnd_s);
  io.stop();
  const bool is_complete = engine.finish();
  return tell_end(&engine, is_complete, io.has_failed(), config.lcm.url);
}

int daemon_main(int argc, char** argv) {
  CommandLine command_line;
  return command_line.asks_for_run(argc, argv) ? run(command_line) : 0;
}

}  // namespace

int main(int argc, char** argv) { return service_main("leonavd", argc, argv, daemon_main); }
