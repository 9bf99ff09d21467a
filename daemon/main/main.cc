// leonavd: the navigation daemon. Exit codes: 0 stopped cleanly; 1 failure while running; 2 wrong
// command line; 3 configuration; 4 LCM or network; 5 journal.
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <functional>
#include <iostream>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>

#include "core/base/gps_time.h"
#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/checkpoint/products_file.h"
#include "daemon/commands/command_gate.h"
#include "daemon/config/config_changes.h"
#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "daemon/config/presets.h"
#include "daemon/engine/engine.h"
#include "daemon/engine/saved_inputs.h"
#include "daemon/engine/solve_time.h"
#include "daemon/health/answer_monitor.h"
#include "daemon/health/health_monitor.h"
#include "daemon/health/thread_monitor.h"
#include "daemon/journal/journal_check.h"
#include "daemon/link/channel_lock.h"
#include "daemon/link/lcm_publisher.h"
#include "daemon/link/service_manager.h"
#include "daemon/process/one_blas_thread.h"
#include "daemon/process/process_signals.h"
#include "daemon/service/lcm_link.h"
#include "daemon/text/checkpoint_text.h"
#include "daemon/threads/process_memory.h"
#include "daemon/threads/realtime_thread.h"
#include "daemon/threads/wall_clock.h"
#include "drivers/text/parse.h"
#include "tools/common/configuration_options.h"
#include "tools/common/service/service_main.h"

namespace {

using namespace leonav;

// Of which the journal may take Journal::kLongestEnd_s. A service manager waits for 20 s.
constexpr unsigned kLongestEnd_s = 15;

extern "C" void end_at_once(int) {
  constexpr char kText[] = "leonavd: error: a thread does not end; ended without it\n";
  std::ignore = write(STDERR_FILENO, kText, sizeof kText - 1);
  _exit(kExitFailure);
}

// OpenBLAS would have started its threads by main().
__attribute__((section(".preinit_array"), used)) const auto kBeforeLibraries =
    start_with_one_blas_thread;

void begin_from_products(const std::string& path, Engine* engine) {
  try {
    const auto products = load_products(path);
    if (!products) return;
    receive_saved(*products, engine);
    spdlog::info("{}: {} ephemerides and {} biases of signals read", path,
                 products->ephemerides.size(), products->biases.size());
  } catch (const ConfigError& error) {
    spdlog::warn("broadcast products ignored: {}", error.what());
  }
}

void begin_from_checkpoint(const std::string& path, Engine* engine) {
  if (path.empty()) return;
  begin_from_products(products_path(path), engine);
  try {
    const auto checkpoint = load_checkpoint(path);
    if (!checkpoint) return spdlog::info("no checkpoint {} to begin from", path);
    receive_saved(*checkpoint, engine);
    spdlog::info("checkpoint {} read", path);
  } catch (const ConfigError& error) {
    spdlog::warn("checkpoint ignored: {}", error.what());
  }
}

// Each once: what became of the checkpoint that was read, and why the next one cannot be written.
class CheckpointLog {
 public:
  void look(Engine* engine) {
    const std::int64_t use = engine->counters().checkpoint_use.get();
    if (use != 0 && use != last_use_) {
      const auto what = static_cast<CheckpointUse>(use - 1);
      const double value = static_cast<double>(engine->counters().checkpoint_milli.get()) * 1e-3;
      const bool ignored = what != CheckpointUse::kUsed && what != CheckpointUse::kNotNeeded;
      spdlog::log(ignored ? spdlog::level::warn : spdlog::level::info, "{}",
                  checkpoint_text(what, value));
    }
    last_use_ = use;
    const std::string error = engine->checkpoint_error();
    if (!error.empty() && error != last_error_) spdlog::warn("no checkpoint: {}", error);
    last_error_ = error;
  }

 private:
  std::int64_t last_use_ = 0;
  std::string last_error_;
};

// Each once: where the journal is, what has begun and ceased to be wrong with it, and what is kept
// of it.
class JournalLog {
 public:
  explicit JournalLog(std::string path) : path_(std::move(path)) {}

  void look(Journal* journal, const JournalHealth& health) {
    if (!named_ && journal->has_file()) {
      named_ = true;
      if (journal->path() != path_)
        spdlog::warn("journal {} exists and is kept; writing {}", path_, journal->path());
    }
    const JournalCounters& counters = journal->counters();
    if (const auto fails = fails_.change(health.has(JournalTrouble::kFails))) {
      if (*fails)
        spdlog::error("{}; a new piece is begun as soon as that can be done",
                      health.text(JournalTrouble::kFails));
      else
        spdlog::info("journal: written again, in piece {}", counters.piece_number.get());
    }
    const bool loses = health.has(JournalTrouble::kLoses) || health.has(JournalTrouble::kLeavesOut);
    if (const auto change = loses_.change(loses)) {
      if (*change)
        spdlog::warn("journal: messages are left out, because the disk is too slow");
      else
        spdlog::warn(
            "journal: nothing is left out any more; {} messages and {} solutions are missing so "
            "far, because the disk was too slow",
            counters.lost_others.get(), counters.lost_solutions.get());
    }
    if (unsynced_.change(health.has(JournalTrouble::kUnsynced)).value_or(false))
      spdlog::error("{}; a power cut now may cost it", health.text(JournalTrouble::kUnsynced));
    if (undeletable_.change(health.has(JournalTrouble::kUndeletable)).value_or(false))
      spdlog::warn("{}; look at the owner and the attributes of the files beside {}",
                   health.text(JournalTrouble::kUndeletable), journal->path());
    tell_kept(journal);
  }

  static void tell_kept(Journal* journal) {
    while (const auto kept = journal->take_kept()) spdlog::info("journal: {} is kept", *kept);
  }

 private:
  class Switch {
   public:
    // The new position, where it has changed.
    std::optional<bool> change(bool on) {
      if (std::exchange(on_, on) == on) return std::nullopt;
      return on;
    }

   private:
    bool on_ = false;
  };
  std::string path_;
  bool named_ = false;
  Switch fails_, loses_, unsynced_, undeletable_;
};

// Reads the configuration again, and puts its reloadable keys into effect.
class Reload {
 public:
  // `running` gets the reloadable keys.
  Reload(std::function<DaemonConfig()> load, DaemonConfig* running, Engine* engine)
      : load_(std::move(load)), running_(running), engine_(engine) {}

  // A configuration that is wrong changes nothing.
  void operator()() {
    try {
      const DaemonConfig read = load_();
      const auto changes = changes_between(running_->source, read.source);
      // Told at the level that holds or at the one that will, whichever tells more.
      set_log_level(std::min(running_->log.level, read.log.level));
      spdlog::info("SIGHUP: {} read again{}", read.source.name,
                   changes.empty() ? ", nothing has changed" : "");
      for (const ConfigChange& change : changes) tell(change);
      reload(read, running_);
      engine_->journal().set_limits(limits_of(running_->journal));
      set_log_level(running_->log.level);
    } catch (const std::exception& error) {
      spdlog::error("SIGHUP: the configuration has errors, nothing is changed: {}", error.what());
    }
  }

  static void set_log_level(LogLevel level) {
    spdlog::set_level(level == LogLevel::kError     ? spdlog::level::err
                      : level == LogLevel::kWarning ? spdlog::level::warn
                                                    : spdlog::level::info);
  }

 private:
  static void tell(const ConfigChange& change) {
    spdlog::log(change.is_reloadable ? spdlog::level::info : spdlog::level::warn,
                "{}: {} -> {}: {}", change.path, change.before, change.after,
                change.is_reloadable ? "in effect" : "needs a restart");
  }

  std::function<DaemonConfig()> load_;
  DaemonConfig* running_;
  Engine* engine_;
};

// Waits a second. True: the daemon is to stop.
bool wait_for_stop(ProcessSignals* signals, const ServiceManager& manager, Reload* reload) {
  const std::int64_t until_ns = monotonic_ns() + kNanosecondsPerSecond;
  for (;;) {
    switch (signals->wait_until(until_ns)) {
      case SignalRequest::kNone:
        return false;
      case SignalRequest::kStop:
        spdlog::info("{}: finishing", signals->name());
        return true;
      case SignalRequest::kReload:
        manager.reloading();
        (*reload)();
        manager.ready();
    }
  }
}

// Once a second, until a signal comes or `io` fails: publishes HEALTH and logs its changes, and
// feeds the watchdog unless a thread hangs or the answer stands still.
void supervise(Engine* engine, HealthMonitor* health, const ServiceManager& manager,
               const DaemonConfig& config, const std::atomic<bool>& io_failed,
               ProcessSignals* signals, Reload* reload) {
  ThreadMonitor watch(engine);
  AnswerMonitor answer(engine);
  CheckpointLog checkpoint_log;
  JournalLog journal_log(config.journal.path);
  KeepRule keep_rule;
  const bool expects_imu = config.navigator.motion == MotionModel::kInertial;
  bool stood_still = false, is_first = true;
  HealthStatus last_status = HealthStatus::kOk;
  std::string last_why, last_suspicions, last_hanging;
  while (!io_failed.load() && !wait_for_stop(signals, manager, reload)) {
    const std::string stalled_threads = watch.stalled_threads();
    engine->publish(Channel::kHealth, health->next(stalled_threads));
    const std::string& why = health->why();
    if (health->status() != last_status || why != last_why || is_first)
      spdlog::info("{}{}{}", to_string(health->status()), why.empty() ? "" : ": ", why);
    is_first = false;
    last_status = health->status();
    last_why = why;
    if (health->suspicions() != last_suspicions)
      spdlog::warn("not as it should be: {}", health->suspicions());
    last_suspicions = health->suspicions();
    checkpoint_log.look(engine);
    journal_log.look(&engine->journal(), health->journal());
    if (keep_rule.look(health->fault())) engine->keep_journal();
    const bool stands_still = answer.stands_still(expects_imu);
    if (stalled_threads.empty() && !stands_still) manager.feed_watchdog();
    if (stands_still && !stood_still) spdlog::error("no answer for a minute, though inputs come");
    stood_still = stands_still;
    if (!stalled_threads.empty() && stalled_threads != last_hanging)
      spdlog::error("thread hangs: {}", stalled_threads);
    last_hanging = stalled_threads;
  }
}

EngineHooks drill_hooks(const DrillConfig& drill) {
  EngineHooks hooks;
  if (drill.late_solve_every == 0) return hooks;
  spdlog::warn("drill: the smoother waits {} s at every {}. epoch", drill.late_solve_s,
               drill.late_solve_every);
  hooks.before_iteration = [drill, last = std::uint64_t{0}](std::uint64_t epoch) mutable {
    if (std::exchange(last, epoch) == epoch) return;  // not the first iteration
    if (epoch % static_cast<std::uint64_t>(drill.late_solve_every) != 0) return;
    std::this_thread::sleep_for(std::chrono::duration<double>(drill.late_solve_s));
  };
  return hooks;
}

// Throws ConfigError where the smoother cannot keep its deadline on this machine.
void check_solve_time(const NavigatorConfig& config) {
  if (config.estimator != Estimator::kSmoother || config.motion != MotionModel::kInertial) return;
  SolveTime time;
  // Not in `main`, whose stack would stay as large. That of the thread goes to `gnss`: it is too
  // large for the threads before it.
  RealtimeThread thread;
  thread.start(
      "measure", ThreadConfig(), [&] { time = measure_solve_time(config); },
      RealtimeThread::kLargestStackBytes);
  thread.join();
  if (time.solved < kMeasuredSolves)
    return spdlog::warn("the smoother's time could not be measured");
  require_in_time(config, time);
  spdlog::info(
      "an iteration over {} keyframes with {} satellites takes {:.1f} ms here, the deadline is "
      "{:.0f} ms",
      config.smoother.window, time.satellites, time.solve_s * 1e3,
      config.realtime.deadline_smoother_s * 1e3);
}

// nullopt: commands need no key. Throws ConfigError where its file cannot be used.
std::optional<CommandGate> command_gate(const DaemonConfig& config) {
  const std::string& path = config.commands.key_file;
  if (path.empty()) return std::nullopt;
  try {
    return CommandGate(CommandKey::from_file(path));
  } catch (const FileError& error) {
    throw ConfigError(config.source.name + ": commands.key_file: " + error.what());
  }
}

// `load` reads the configuration from the command line and its file, each time it is called.
int run(const std::function<DaemonConfig()>& load) {
  DaemonConfig config = load();
  Reload::set_log_level(config.log.level);
  std::optional<CommandGate> gate = command_gate(config);
  prepare_memory();
  const ChannelLock lock(config.lcm);
  check_solve_time(config.navigator);
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is a failure of a write

  const ServiceManager manager;
  if (!manager.problem().empty()) spdlog::warn("{}", manager.problem());
  LcmPublisher publisher(config.lcm);
  Engine engine(config, &publisher, drill_hooks(config.drill));
  // Before any thread is started. Where the start fails, a signal ends what waits in ~Engine.
  std::optional<ProcessSignals> signals(std::in_place);
  LcmReceiver receiver(config.lcm, config.threads.io, &engine, std::move(gate));
  if (!receiver.refused().empty()) spdlog::warn("{}", receiver.refused());
  for (const std::string& refused : engine.start()) spdlog::warn("{}", refused);

  begin_from_checkpoint(config.checkpoint.path, &engine);

  std::atomic<bool> stop{false}, io_failed{false};
  RealtimeThread io;
  const std::string refused = io.start("io", config.threads.io, [&] {
    while (!stop.load()) {
      engine.counters().io_rounds.add(1);
      if (!receiver.receive(100)) {
        io_failed.store(true);
        return;
      }
    }
  });
  if (!refused.empty()) spdlog::warn("{}", refused);
  spdlog::info("running; LCM {}, channels {}*, journal {}", config.lcm.url, config.lcm.prefix,
               engine.journal().path().empty() ? "off" : engine.journal().path());
  if (!config.commands.key_file.empty())
    spdlog::info("commands: only those signed with the key of {}", config.commands.key_file);

  HealthMonitor health(&engine, config.navigator);
  manager.ready();
  Reload reload(load, &config, &engine);
  supervise(&engine, &health, manager, config, io_failed, &*signals, &reload);
  manager.stopping();

  signals.reset();  // from here on a second signal kills
  std::signal(SIGALRM, end_at_once);
  alarm(kLongestEnd_s);
  stop.store(true);
  io.join();
  const bool complete = engine.finish();
  JournalLog::tell_kept(&engine.journal());
  if (!complete) {
    spdlog::error("{}", engine.journal().error());
    return kExitJournal;
  }
  if (io_failed.load()) {
    spdlog::error("LCM at '{}' failed while receiving", config.lcm.url);
    return kExitFailure;
  }
  EngineCounters& counters = engine.counters();
  spdlog::info(
      "stopped; {} messages published, {} journaled, {} deadline misses, {} of the smoother",
      counters.published.get(), engine.journal().counters().journaled.get(), counters.misses.get(),
      counters.smoother_misses.get());
  return 0;
}

// The configuration with everything the command line changes in it, so that a journal holds it
// all. A reload reads a file only, because a pipe could hold it up.
DaemonConfig configuration(const Arguments& arguments, bool is_reload = false) {
  std::vector<std::string> overrides;
  if (arguments.has("--lcm-url")) {
    overrides.push_back(text_override("lcm.url", arguments.get("--lcm-url")));
  }
  if (arguments.has("--journal")) {
    overrides.push_back(text_override("journal.path", arguments.get("--journal")));
  }
  const std::string file = arguments.has("--config") ? arguments.get("--config") : "";
  std::error_code error;
  if (is_reload && !file.empty() && !std::filesystem::is_regular_file(file, error))
    throw ConfigError(file + ": is no file that can be read again; restart leonavd");
  DaemonConfig config = load_configuration(arguments, overrides);
  require_journal(config);
  return config;
}

// Throws ConfigError where the configuration is wrong.
int check(const Arguments& arguments) {
  const DaemonConfig config = configuration(arguments);
  std::ignore = command_gate(config);
  const bool changes = arguments.has("--changes");
  std::cout << effective_text(config.source, changes ? Extent::kChanges : Extent::kAllKeys);
  spdlog::info("{}: good", config.source.name);
  return 0;
}

int daemon_main(int argc, char** argv) {
  Arguments arguments(
      "leonavd", "--config FILE [options]\n       leonavd --check [--config] FILE [options]",
      "The navigation daemon: takes IMU and GNSS from LCM, publishes position, velocity and "
      "attitude.\nSIGTERM and SIGINT end it cleanly, with the journal complete; a second one at "
      "once.\nSIGHUP reads the configuration again: the log says of each changed key whether it "
      "is in effect\n(journal.flush_interval_s, piece_mb, piece_s, total_mb, kept_mb; log.level) "
      "or needs a restart.\nExit codes: 0 stopped cleanly, 1 failure while running, 2 command "
      "line, 3 "
      "configuration, 4 LCM, 5 journal.");
  add_configuration_options(&arguments);
  arguments.option("--lcm-url", "URL", "instead of lcm.url")
      .option("--journal", "FILE",
              "instead of journal.path; an LCM log that replays bit for bit; a file "
              "that exists is kept, and FILE.1, FILE.2, ... written")
      .flag("--check",
            "run nothing: print the effective value of every key and where it is from, or what is "
            "wrong")
      .flag("--changes", "with --check: print only the keys that differ from the defaults")
      .flag("--reference", "print every key with its default, its range and its meaning")
      .flag("--reasons", "print every reason of HEALTH with what to do, as a table in Markdown");
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.has("--reference")) {
    std::cout << reference_text();
    return 0;
  }
  if (arguments.has("--reasons")) {
    std::cout << health_reasons_as_markdown();
    return 0;
  }
  const bool checks = arguments.has("--check");
  if (checks && arguments.positional().size() == 1) arguments.take_positional_as("--config");
  if (!arguments.positional().empty()) {
    throw UsageError("unexpected argument '" + arguments.positional().front() +
                     "' (leonavd --help)");
  }
  if (arguments.has("--changes") && !checks) throw UsageError("--changes goes with --check");
  if (checks) return check(arguments);
  return run([&, is_reload = false]() mutable {
    return configuration(arguments, std::exchange(is_reload, true));
  });
}

}  // namespace

int main(int argc, char** argv) { return service_main("leonavd", argc, argv, daemon_main); }
