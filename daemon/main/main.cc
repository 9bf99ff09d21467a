// leonavd: the navigation daemon. Exit codes: 0 stopped cleanly; 1 failure while running; 2 wrong
// command line; 3 configuration; 4 LCM or network; 5 journal.
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <ctime>
#include <iostream>
#include <thread>
#include <utility>

#include "daemon/checkpoint/checkpoint_file.h"
#include "daemon/checkpoint/products_file.h"
#include "daemon/config/effective_config.h"
#include "daemon/config/load_config.h"
#include "daemon/config/presets.h"
#include "daemon/engine/engine.h"
#include "daemon/engine/saved_inputs.h"
#include "daemon/engine/solve_time.h"
#include "daemon/health/answer_monitor.h"
#include "daemon/health/health_monitor.h"
#include "daemon/health/thread_monitor.h"
#include "daemon/link/channel_lock.h"
#include "daemon/link/lcm_publisher.h"
#include "daemon/link/service_manager.h"
#include "daemon/service/lcm_link.h"
#include "daemon/text/checkpoint_text.h"
#include "daemon/threads/wall_clock.h"
#include "tools/common/configuration_options.h"
#include "tools/common/service/service_main.h"

namespace {

using namespace leonav;

// Blocked in every thread of leonavd; `main` takes them one at a time. A second one ends the
// process at once.
sigset_t stop_signals() {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGTERM);
  sigaddset(&set, SIGINT);
  return set;
}

pthread_t main_thread;

// Libraries have threads that were there before main() and block nothing (OpenBLAS). A signal that
// the kernel gives to one of them goes on to the main thread instead of ending the process.
extern "C" void pass_to_main_thread(int signal) { pthread_kill(main_thread, signal); }

void take_stop_signals_in_this_thread() {
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);  // before any thread is started: all inherit it
  main_thread = pthread_self();
  std::signal(SIGTERM, pass_to_main_thread);
  std::signal(SIGINT, pass_to_main_thread);
}

void begin_from_products(const std::string& path, Engine* engine) {
  try {
    const auto products = load_products(path);
    if (!products) return;
    receive_saved(*products, engine);
    spdlog::info("{}: {} ephemerides read", path, products->ephemerides.size());
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

// Each once: that the disk fails, what was lost, and that the journal goes on.
class JournalLog {
 public:
  void look(const Journal& journal) {
    const JournalCounters& counters = journal.counters();
    const std::int64_t lost = counters.lost_others.get(), left_out = counters.lost_solutions.get();
    const std::int64_t piece = counters.piece_number.get();
    const bool loses = lost != last_lost_ || left_out != last_left_out_;
    // At the end of a loss, when its size is known.
    if (lost_ && !loses) {
      spdlog::warn(
          "journal: {} messages and {} solutions are missing so far; the disk was too slow", lost,
          left_out);
    }
    lost_ = loses;
    last_lost_ = lost;
    last_left_out_ = left_out;
    const std::string failure = journal.failure();
    if (last_failure_.empty() && !failure.empty())
      spdlog::error("journal: {}; a new piece is begun as soon as that can be done", failure);
    if (!last_failure_.empty() && failure.empty())
      spdlog::info("journal: written again, in piece {}", piece);
    last_failure_ = failure;
  }

 private:
  std::int64_t last_lost_ = 0, last_left_out_ = 0;
  bool lost_ = false;
  std::string last_failure_;
};

// Once a second, until a signal comes or `io` fails: publishes HEALTH and logs its changes, and
// feeds the watchdog unless a thread hangs or the answer stands still.
void supervise(Engine* engine, HealthMonitor* health, const ServiceManager& manager,
               bool expects_imu, const std::atomic<bool>& io_failed) {
  const sigset_t set = stop_signals();
  const timespec second{1, 0};
  ThreadMonitor watch(engine);
  AnswerMonitor answer(engine);
  CheckpointLog checkpoint_log;
  JournalLog journal_log;
  bool had_answer = false, stood_still = false;
  std::string last, last_suspicions, last_hanging;
  while (!io_failed.load()) {
    if (const int signal = sigtimedwait(&set, nullptr, &second); signal > 0) {
      spdlog::info("{}: finishing", signal == SIGTERM ? "SIGTERM" : "SIGINT");
      return;
    }
    const std::string stalled_threads = watch.stalled_threads();
    engine->publish(Channel::kHealth, health->next(stalled_threads));
    const std::string why = health->why();
    const std::string now =
        std::string(to_string(health->status())) + (why.empty() ? "" : ": ") + why;
    if (now != last) spdlog::info("{}", now);
    last = now;
    if (health->suspicions() != last_suspicions)
      spdlog::warn("not as it should be: {}", health->suspicions());
    last_suspicions = health->suspicions();
    checkpoint_log.look(engine);
    journal_log.look(engine->journal());
    // What led up to a fault is worth keeping; that there is no answer yet is none.
    if (had_answer && health->status() == HealthStatus::kFault) engine->keep_journal();
    had_answer = health->status() != HealthStatus::kFault;
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
  const SolveTime time = measure_solve_time(config);
  if (time.solved < kMeasuredSolves)
    return spdlog::warn("the smoother's time could not be measured");
  require_in_time(config, time);
  spdlog::info(
      "an iteration over {} keyframes with {} satellites takes {:.1f} ms here, the deadline is "
      "{:.0f} ms",
      config.smoother.window, time.satellites, time.solve_s * 1e3,
      config.realtime.deadline_smoother_s * 1e3);
}

int run(const DaemonConfig& config) {
  const ChannelLock lock(config.lcm);
  check_solve_time(config.navigator);
  take_stop_signals_in_this_thread();
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is a failure of a write

  const ServiceManager manager;
  if (!manager.problem().empty()) spdlog::warn("{}", manager.problem());
  LcmPublisher publisher(config.lcm);
  Engine engine(config, &publisher, drill_hooks(config.drill));
  LcmReceiver receiver(config.lcm, config.threads.io, &engine);
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
  if (engine.journal().path() != config.journal.path) {
    spdlog::warn("journal {} exists and is kept; writing {}", config.journal.path,
                 engine.journal().path());
  }

  HealthMonitor health(&engine, config.navigator);
  manager.ready();
  supervise(&engine, &health, manager, config.navigator.motion == MotionModel::kInertial,
            io_failed);
  manager.stopping();

  std::signal(SIGTERM, SIG_DFL);
  std::signal(SIGINT, SIG_DFL);
  const sigset_t set = stop_signals();
  pthread_sigmask(SIG_UNBLOCK, &set, nullptr);  // from here on a second signal kills
  stop.store(true);
  io.join();
  if (!engine.finish()) {
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
// all.
DaemonConfig configuration(const Arguments& arguments) {
  std::vector<std::string> overrides;
  if (arguments.has("--lcm-url")) {
    overrides.push_back(text_override("lcm.url", arguments.get("--lcm-url")));
  }
  if (arguments.has("--journal")) {
    overrides.push_back(text_override("journal.path", arguments.get("--journal")));
  }
  return load_configuration(arguments, overrides);
}

// Throws ConfigError where the configuration is wrong.
int check(const Arguments& arguments) {
  const DaemonConfig config = configuration(arguments);
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
      "once.\nExit codes: 0 stopped cleanly, 1 failure while running, 2 command line, 3 "
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
  return checks ? check(arguments) : run(configuration(arguments));
}

}  // namespace

int main(int argc, char** argv) { return service_main("leonavd", argc, argv, daemon_main); }
