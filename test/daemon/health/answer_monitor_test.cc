// When the watchdog is told that the answer stands still.
#include "daemon/health/answer_monitor.h"

#include "discard.h"
#include "support/catch.h"
#include "support/drive/drive_inputs.h"

namespace {

using namespace leonav;
using test::Discard;

// An engine that is not started: the test sets its counters, a second at each look.
class Looks {
 public:
  explicit Looks(const NavigatorConfig& config = DaemonConfig().navigator)
      : engine_(test::drive_config(), &target_), monitor_(&engine_, config) {
    engine_.counters().satellites_used[0].set(8);
  }
  bool look(bool has_input, bool has_answer) {
    EngineCounters& counters = engine_.counters();
    receive(has_input ? 200 : 0, has_input ? 1 : 0);
    if (has_input) {
      counters.accepted_imu.add(200);
      counters.accepted_epochs.add(1);
    }
    if (has_answer) counters.solution_time_ns.add(1'000'000'000);
    return monitor_.stands_still();
  }
  // Both streams come, and the Sequencer rejects all of it by this fault.
  bool look_rejecting(InputFault imu, InputFault epochs) {
    receive(200, 1);
    reject(Channel::kImu, imu, 200);
    reject(Channel::kGnssEpoch, epochs, 1);
    return monitor_.stands_still();
  }
  // Both streams come, and one is used.
  bool look_rejecting_epochs(InputFault fault) {
    receive(200, 1);
    engine_.counters().accepted_imu.add(200);
    reject(Channel::kGnssEpoch, fault, 1);
    return look();
  }
  bool look_rejecting_imu_alone(InputFault fault) {
    receive(200, 0);
    reject(Channel::kImu, fault, 200);
    return look();
  }
  // Both streams come, and are refused as they are decoded.
  bool look_refusing() {
    receive(200, 1);
    engine_.counters().refused[index_of(Channel::kImu)].add(200);
    engine_.counters().refused[index_of(Channel::kGnssEpoch)].add(1);
    engine_.counters().rejected[static_cast<std::size_t>(InputFault::kUndecodable)].add(201);
    return monitor_.stands_still();
  }
  EngineCounters& counters() { return engine_.counters(); }
  bool look() { return monitor_.stands_still(); }

 private:
  void receive(std::int64_t imu, std::int64_t epochs) {
    engine_.counters().received[index_of(Channel::kImu)].add(imu);
    engine_.counters().received[index_of(Channel::kGnssEpoch)].add(epochs);
  }
  void reject(Channel channel, InputFault fault, std::int64_t count) {
    const std::size_t stream = channel == Channel::kImu ? 0 : 1,
                      of = static_cast<std::size_t>(fault);
    engine_.counters().rejected_of_stream[stream][of].add(count);
    engine_.counters().rejected[of].add(count);
  }

  Discard target_;
  Engine engine_;
  AnswerMonitor monitor_;
};

}  // namespace

TEST_CASE("an answer that stands still for a minute while inputs come is found, and not before") {
  Looks looks;
  looks.look(true, true);
  for (int second = 1; second < 60; ++second) CHECK_FALSE(looks.look(true, false));
  CHECK(looks.look(true, false));
  CHECK_FALSE(looks.look(true, true));  // it goes on
}

TEST_CASE("an answer that is asked for more rarely than once a minute is waited for") {
  NavigatorConfig config;
  config.solution_rate_hz = 0.01;
  Looks looks(config);
  looks.look(true, true);
  for (int second = 1; second < 250; ++second) CHECK_FALSE(looks.look(true, false));
  CHECK(looks.look(true, false));
}

TEST_CASE("an answer that ends because all inputs are rejected for their time is found") {
  for (const InputFault imu : {InputFault::kTimeBackwards, InputFault::kTooFarAhead}) {
    for (const InputFault epochs : {InputFault::kTimeBackwards, InputFault::kTooFarAhead}) {
      Looks looks;
      looks.look(true, true);
      for (int second = 1; second < 60; ++second) CHECK_FALSE(looks.look_rejecting(imu, epochs));
      CHECK(looks.look_rejecting(imu, epochs));
      CHECK_FALSE(looks.look(true, true));
    }
  }
}

// With an IMU, empty epochs would be issued in their place.
TEST_CASE("without an IMU, epochs that are all too late are found as those of a wrong time are") {
  NavigatorConfig config;
  config.motion = MotionModel::kConstantVelocity;
  Looks looks(config);
  looks.look(true, true);
  bool found = false;
  for (int second = 1; second <= 60; ++second) {
    CHECK_FALSE(found);
    looks.counters().late_epochs.add(1);
    found = looks.look();
  }
  CHECK(found);
}

TEST_CASE("an IMU that is used and epochs of another time are nothing that a restart mends") {
  for (const InputFault fault : {InputFault::kTimeBackwards, InputFault::kTooFarAhead}) {
    Looks imu, late;
    for (Looks* looks : {&imu, &late}) looks->look(true, true);
    for (int second = 0; second < 200; ++second) {
      CHECK_FALSE(imu.look_rejecting_epochs(fault));
      late.counters().accepted_imu.add(200);
      late.counters().late_epochs.add(1);
      CHECK_FALSE(late.look());
    }
  }
}

TEST_CASE(
    "an answer of GNSS alone that stands still is found a minute after the IMU counts as gone") {
  // The epochs come each `every` seconds, the IMU does not come or is of another time.
  const int every = GENERATE(1, 10);
  const bool other_time = GENERATE(false, true);
  CAPTURE(every, other_time);
  Looks stands, goes_on;
  for (Looks* looks : {&stands, &goes_on}) looks->look(true, true);
  const auto look = [&](int second, Looks* looks) {
    if (second % every == 0) looks->counters().accepted_epochs.add(1);
    return other_time ? looks->look_rejecting_imu_alone(InputFault::kTooFarAhead) : looks->look();
  };
  int found = 0;
  for (int second = 1; second <= 1000 && found == 0; ++second) {
    if (look(second, &stands)) found = second;
    if (second % every == 0) goes_on.counters().solution_time_ns.add(1'000'000'000);
    CHECK_FALSE(look(second, &goes_on));
  }
  CHECK(found >= 60 + 60 * every);
  CHECK(found <= 61 + 61 * every);
}

TEST_CASE("no answer without inputs or satellites is nothing that a restart mends") {
  Looks silent, blind;
  silent.look(true, true);
  blind.look(true, true);
  blind.counters().satellites_used[0].set(0);
  for (int second = 0; second < 200; ++second) {
    CHECK_FALSE(silent.look(false, false));
    CHECK_FALSE(blind.look(true, false));
  }
}

TEST_CASE("inputs that are their sender's fault are nothing that a restart mends") {
  Looks junk;
  junk.look(true, true);
  for (int second = 0; second < 200; ++second) CHECK_FALSE(junk.look_refusing());
  for (const InputFault fault : {InputFault::kNotFinite, InputFault::kOutOfRange,
                                 InputFault::kDuplicate, InputFault::kNotSane}) {
    Looks both, imu, epochs;
    for (Looks* looks : {&both, &imu, &epochs}) looks->look(true, true);
    for (int second = 0; second < 200; ++second) {
      CHECK_FALSE(both.look_rejecting(fault, fault));
      CHECK_FALSE(imu.look_rejecting(fault, InputFault::kTooFarAhead));
      CHECK_FALSE(epochs.look_rejecting(InputFault::kTooFarAhead, fault));
    }
  }
}

TEST_CASE("a restart that brings no answer is not followed by another one") {
  Looks restarted;  // without an answer since it has begun
  for (int second = 0; second < 200; ++second) {
    CHECK_FALSE(restarted.look(true, false));
    CHECK_FALSE(restarted.look_rejecting(InputFault::kTimeBackwards, InputFault::kTooFarAhead));
  }
}
