// The engine with the smoother in its thread: in time it gives the single thread's bytes; late, the
// filter answers, every miss is told, and the journal's decisions give the same bytes again.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <leonav/event_t.hpp>
#include <leonav/smoother_t.hpp>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "daemon/engine/engine.h"
#include "engine_runs.h"
#include "support/wait_a_moment.h"

namespace {

using namespace leonav;
using test::Bytes;
using test::check_same;
using test::Collector;
using test::Input;

constexpr std::size_t kDecisions = 1, kGnssEvents = 5, kSmoother = 7, kKeyframes = 8;

const std::vector<Input>& whole_drive() {
  static const std::vector<Input> list = test::drive_messages([](Channel) { return true; });
  return list;
}

// Where the smoother is held at every third keyframe until its deadline has passed, while all other
// stages keep up: before its first iteration or, with a solve begun, before the second.
enum class Hold { kNever, kBefore, kWithin };

DaemonConfig smoother_config() {
  DaemonConfig config = test::drive_config();
  config.navigator.estimator = Estimator::kSmoother;
  config.navigator.smoother.window = 8;
  config.navigator.smoother.time_limit_s = 0.0;  // nothing here may depend on the clock
  config.navigator.smoother.max_iterations = 4;  // so that there are some to be held at or cut off
  config.navigator.smoother.converged_sigmas = 0.01;
  return config;
}

// With the smoother's answers before them: of the last epochs nothing has been decided yet.
std::vector<Decision> decisions_of(const Collector& outputs) {
  Decoder decoder;
  std::vector<Decision> decisions;
  for (const Bytes& bytes : outputs.groups[kSmoother]) {
    SmootherReport report;
    REQUIRE(decoder.decode(bytes, &report).fault == InputFault::kNone);
    decisions.push_back(decision_of(report));
  }
  for (const std::size_t group : {kDecisions, kKeyframes}) {
    for (const Bytes& bytes : outputs.groups[group]) {
      Decision decision;
      REQUIRE(decoder.decode(bytes, &decision).fault == InputFault::kNone);
      decisions.push_back(decision);
    }
  }
  return decisions;
}

// The same with the command to restart the filter behind an epoch.
std::vector<Input> inputs_with_restart() {
  std::vector<Input> list;
  Encoder encoder;
  int epochs = 0;
  for (const Input& input : whole_drive()) {
    list.push_back(input);
    if (input.channel != Channel::kGnssEpoch || ++epochs != 30) continue;
    const ByteSpan bytes = encoder.encode(Command(), test::kSkyEpoch, 1);
    list.push_back({Channel::kCommand, {bytes.begin(), bytes.end()}});
  }
  return list;
}

Collector replay(const std::vector<Decision>& decisions,
                 const std::vector<Input>& list = whole_drive()) {
  return test::run_navigator(smoother_config().navigator, list, decisions);
}

bool is_done(const WorkCount& work) { return work.done == work.pushed; }

Collector run_engine(Hold hold, const DaemonConfig& config,
                     const std::vector<Input>& list = whole_drive()) {
  std::atomic<std::uint64_t> samples{0}, held_until{0};
  std::uint64_t last_epoch = 0;
  int iteration = 0;
  EngineHooks hooks;
  hooks.before_iteration = [&](std::uint64_t epoch) {
    iteration = std::exchange(last_epoch, epoch) == epoch ? iteration + 1 : 0;
    if (hold == Hold::kNever || epoch % 3 != 0) return;
    if (iteration != (hold == Hold::kBefore ? 0 : 1)) return;
    const std::uint64_t until = std::min<std::uint64_t>(samples.load() + 150, list.size());
    held_until = until;
    while (samples.load() < until) test::wait_a_moment();  // 0.75 s of data
  };
  Collector outputs;
  Engine engine(config, &outputs, hooks);
  engine.start();
  std::int64_t stamp = 0;
  for (const Input& input : list) {
    engine.receive(input.channel, input.bytes, ++stamp);
    ++samples;
    while (!engine.idle() && !(samples.load() < held_until.load() && is_done(engine.gnss_work()) &&
                               is_done(engine.inertial_work())))
      test::wait_a_moment();
  }
  REQUIRE(engine.finish());
  return outputs;
}

Collector run_engine(Hold hold, double time_limit_s = 0.0,
                     const std::vector<Input>& list = whole_drive()) {
  DaemonConfig config = smoother_config();
  config.navigator.smoother.time_limit_s = time_limit_s;
  return run_engine(hold, config, list);
}

int resets_of(const Collector& outputs, ResetCause cause) {
  int resets = 0;
  for (const Bytes& bytes : outputs.groups[kGnssEvents]) {
    event_t event{};
    const int size = static_cast<int>(bytes.size());
    REQUIRE(event.decode(bytes.data(), 0, size) == size);
    const bool reset = event.kind == static_cast<int>(EventKind::kFilterReset);
    resets += reset && event.code == static_cast<int>(cause) ? 1 : 0;
  }
  return resets;
}

int reports_of(const Collector& outputs, SmootherStatus status) {
  int reports = 0;
  for (const Bytes& bytes : outputs.groups[kSmoother]) {
    smoother_t report{};
    const int size = static_cast<int>(bytes.size());
    REQUIRE(report.decode(bytes.data(), 0, size) == size);
    reports += report.status == static_cast<int>(status) ? 1 : 0;
  }
  return reports;
}

int missed_of(const std::vector<Decision>& decisions, Decision::Subject subject) {
  int missed = 0;
  for (const Decision& decision : decisions)
    missed += decision.subject == subject && !decision.committed ? 1 : 0;
  return missed;
}

}  // namespace

TEST_CASE("a smoother in time gives the bytes of the single thread") {
  const Collector threaded = run_engine(Hold::kNever);
  CHECK(missed_of(decisions_of(threaded), Decision::Subject::kFilter) == 0);
  CHECK(missed_of(decisions_of(threaded), Decision::Subject::kSmoother) == 0);
  check_same(replay({}), threaded);
  CHECK(threaded.groups[kSmoother].size() > 50);
}

TEST_CASE("a smoother that is late leaves the filter's answer, and its run replays") {
  const Hold hold = GENERATE(Hold::kBefore, Hold::kWithin);
  const Collector in_time = run_engine(Hold::kNever);
  const Collector late = run_engine(hold);
  const std::vector<Decision> decisions = decisions_of(late);
  const int missed = missed_of(decisions, Decision::Subject::kSmoother);
  CHECK(missed >= 10);
  CHECK(missed <= 40);
  CHECK(missed_of(decisions, Decision::Subject::kFilter) == 0);
  // The answer has not stopped, and the smoother has returned.
  CHECK(late.groups[0].size() == in_time.groups[0].size());
  CHECK(late.groups[kSmoother].size() >= 15);
  check_same(replay(decisions), late);
}

TEST_CASE("solves that fail by a drill fail in the replay too, with and without misses") {
  const auto [failure, hold, status] =
      GENERATE(std::tuple(DrilledFailure::kSingular, Hold::kNever, SmootherStatus::kSingular),
               std::tuple(DrilledFailure::kDiverged, Hold::kBefore, SmootherStatus::kDiverged));
  DaemonConfig config = smoother_config();
  config.navigator.smoother.drill_failure_every = 4;
  config.navigator.smoother.drill_failure = failure;
  const Collector live = run_engine(hold, config);
  CHECK(reports_of(live, status) >= 10);
  check_same(test::run_navigator(config.navigator, whole_drive(), decisions_of(live)), live);
}

TEST_CASE("solves that time has cut short replay with as many iterations, the last ones too") {
  const Collector in_time = run_engine(Hold::kNever), hurried = run_engine(Hold::kNever, 1e-9);
  CHECK(in_time.groups[kSmoother] != hurried.groups[kSmoother]);
  check_same(replay(decisions_of(hurried)), hurried);
}

TEST_CASE("a filter that follows the window after a restart replays, with and without misses") {
  const Hold hold = GENERATE(Hold::kNever, Hold::kBefore, Hold::kWithin);
  const std::vector<Input> list = inputs_with_restart();
  const Collector live = run_engine(hold, 0.0, list);
  CHECK(resets_of(live, ResetCause::kCommand) == 1);
  CHECK(resets_of(live, ResetCause::kWindow) == 1);
  check_same(replay(decisions_of(live), list), live);
}
