// The engine with the smoother in its thread: in time it gives the single thread's bytes; late, the
// filter answers, every miss is told, and the journal's decisions give the same bytes again.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>
#include <vector>

#include "daemon/engine.h"
#include "engine_runs.h"

namespace {

using namespace leonav;
using test::Bytes;
using test::check_same;
using test::Collector;
using test::Input;

constexpr std::size_t kDecisions = 1, kSmoother = 7, kKeyframes = 8;

const std::vector<Input>& inputs() {
  static const std::vector<Input> list = test::drive_messages([](Channel) { return true; });
  return list;
}

DaemonConfig smoother_config() {
  DaemonConfig config = test::drive_config();
  config.navigator.estimator = Estimator::kSmoother;
  config.navigator.smoother.window = 8;
  config.navigator.smoother.time_limit_s = 0.0;  // nothing here may depend on the clock
  return config;
}

std::vector<Decision> decisions_of(const Collector& outputs) {
  Decoder decoder;
  std::vector<Decision> decisions;
  for (const std::size_t group : {kDecisions, kKeyframes}) {
    for (const Bytes& bytes : outputs.groups[group]) {
      Decision decision;
      REQUIRE(decoder.decode(bytes, &decision).fault == InputFault::kNone);
      decisions.push_back(decision);
    }
  }
  return decisions;
}

Collector replay(const std::vector<Decision>& decisions) {
  return test::run_pipeline(smoother_config().navigator, inputs(), decisions);
}

bool is_done(const WorkCount& work) { return work.done == work.pushed; }

// Late: the smoother is held before its first iteration of every third keyframe until its deadline
// has passed, while all other stages keep up.
Collector run_engine(bool late) {
  std::atomic<std::uint64_t> samples{0};
  std::atomic<bool> held{false};
  EngineHooks hooks;
  hooks.before_iteration = [&](std::uint64_t epoch) {
    if (!late || epoch % 3 != 0) return;
    const std::uint64_t until = std::min<std::uint64_t>(samples.load() + 150, inputs().size());
    held = true;
    while (samples.load() < until) std::this_thread::yield();  // 0.75 s of data
    held = false;
  };
  Collector outputs;
  Engine engine(smoother_config(), &outputs, hooks);
  engine.start();
  std::int64_t stamp = 0;
  for (const Input& input : inputs()) {
    engine.receive(input.channel, input.bytes, ++stamp);
    ++samples;
    while (!engine.idle() &&
           !(held.load() && is_done(engine.gnss_work()) && is_done(engine.inertial_work())))
      std::this_thread::yield();
  }
  REQUIRE(engine.finish());
  return outputs;
}

int missed_of(const std::vector<Decision>& decisions, int mailbox) {
  int missed = 0;
  for (const Decision& decision : decisions)
    missed += decision.mailbox == mailbox && !decision.committed ? 1 : 0;
  return missed;
}

}  // namespace

TEST_CASE("a smoother in time gives the bytes of the single thread") {
  const Collector threaded = run_engine(false);
  CHECK(missed_of(decisions_of(threaded), 0) == 0);
  CHECK(missed_of(decisions_of(threaded), 1) == 0);
  check_same(replay({}), threaded);
  CHECK(threaded.groups[kSmoother].size() > 50);
}

TEST_CASE("a smoother that is late leaves the filter's answer, and its run replays") {
  const Collector in_time = run_engine(false);
  const Collector late = run_engine(true);
  const std::vector<Decision> decisions = decisions_of(late);
  const int missed = missed_of(decisions, 1);
  CHECK(missed >= 10);
  CHECK(missed <= 40);
  CHECK(missed_of(decisions, 0) == 0);
  // The answer has not stopped, and the smoother has returned.
  CHECK(late.groups[0].size() == in_time.groups[0].size());
  CHECK(late.groups[kSmoother].size() >= 15);
  check_same(replay(decisions), late);
}
