// What a restart does to the answer at the IMU's rate, and to the epochs under way.
#include <algorithm>

#include "inertial_rig.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

// Epoch 1 is the anchor, epoch 2 is under way at 2.1 s.
void feed_until_2_1_s(InertialRig* rig) {
  rig->feed(0.0, 1.0);
  rig->issue(1, 1.0, 0.1);
  rig->mailbox.deliver(1, rig->anchor(1, 1.0));
  rig->feed(1.0, 2.0);
  rig->issue(2, 2.0, 0.2);
  rig->mailbox.deliver(2, rig->anchor(2, 2.0, 50.0));
  rig->feed(2.0, 2.1);
}

TEST_CASE("after a restart nothing is published until an anchor that was issued after it") {
  InertialRig rig;
  feed_until_2_1_s(&rig);
  const std::size_t before = rig.sink.solutions.size();
  CHECK(before == 201);
  rig.navigator.process(Restart{ResetCause::kCommand});
  CHECK(rig.navigator.source() == Source::kNone);
  rig.feed(2.1, 2.5);
  CHECK(rig.sink.solutions.size() == before);
  CHECK(rig.navigator.source() == Source::kNone);
  // The epoch under way was in time: no miss, at its own deadline.
  REQUIRE(rig.sink.decisions.size() == 2);
  CHECK(rig.sink.decisions[1].committed);
  CHECK(seconds(rig.sink.decisions[1].time) == Approx(2.2));
  CHECK(rig.navigator.misses() == 0);
  CHECK(rig.sink.count(EventKind::kDeadlineMiss) == 0);

  rig.issue(3, 2.5, 0.1);
  Anchor aligning = rig.anchor(3, 2.5);
  aligning.has_attitude = false;
  rig.mailbox.deliver(3, aligning);
  rig.feed(2.5, 3.0);
  REQUIRE(rig.sink.solutions.size() > before);
  CHECK(seconds(rig.sink.solutions[before].time) == Approx(2.6));
  for (std::size_t i = before; i < rig.sink.solutions.size(); ++i) {
    CHECK(rig.sink.solutions[i].source == Source::kAligning);
    CHECK(rig.sink.solutions[i].sequence == i + 1);
    CHECK(rig.sink.solutions[i].jump_m == 0.0);
  }
  CHECK(rig.sink.count(EventKind::kSolutionJump) == 0);
}

TEST_CASE("the samples before a restart serve an epoch that is older than the command") {
  InertialRig restarted, undisturbed;
  for (InertialRig* rig : {&restarted, &undisturbed}) {
    feed_until_2_1_s(rig);
    if (rig == &restarted) rig->navigator.process(Restart{ResetCause::kCommand});
    rig->issue(3, 2.0512, 0.3);
    rig->mailbox.deliver(3, rig->anchor(3, 2.0512));
    rig->feed(2.1, 4.0);
  }
  const Solution &a = restarted.sink.solutions.back(), &b = undisturbed.sink.solutions.back();
  CHECK(a.anchor_epoch == 3);
  CHECK(a.p_e == b.p_e);
  CHECK(a.v_n == b.v_n);
  CHECK(a.sigma_p_n == b.sigma_p_n);
}

TEST_CASE("GNSS of before a restart does not make the answer after it more than inertial") {
  InertialRig rig;
  feed_until_2_1_s(&rig);
  rig.navigator.process(Restart{ResetCause::kCommand});
  rig.issue(3, 2.1, 0.1);
  Anchor update = rig.anchor(3, 2.1);
  update.gnss_used = false;
  rig.mailbox.deliver(3, update);
  rig.feed(2.1, 2.5);
  CHECK(rig.sink.solutions.back().anchor_epoch == 3);
  CHECK(rig.sink.solutions.back().source == Source::kInsOnly);
}

TEST_CASE("a restart because time changed decides all that waits at once and keeps nothing") {
  InertialRig rig;
  feed_until_2_1_s(&rig);
  rig.issue(3, 2.1, 0.2);  // not delivered
  const std::size_t before = rig.sink.solutions.size();
  rig.navigator.process(Restart{ResetCause::kTimeBase});
  CHECK(rig.navigator.source() == Source::kNone);
  REQUIRE(rig.sink.decisions.size() == 3);
  CHECK(rig.sink.decisions[1].committed);
  CHECK_FALSE(rig.sink.decisions[2].committed);
  rig.feed(1.0, 1.5);
  CHECK(rig.sink.solutions.size() == before);
  rig.issue(4, 1.5, 0.1);
  rig.mailbox.deliver(4, rig.anchor(4, 1.5));
  rig.feed(1.5, 2.0);
  CHECK(rig.sink.solutions.back().anchor_epoch == 4);
}

// The drive with something done just before its 40th epoch arrives, behind the first IMU sample at
// or after 40.06 s and the clock's offset: that of 40.065 s.
constexpr double kCommand_s = 40.065;

template <typename Do>
RecordingSink drive_with(const SyntheticDrive& drive, Do at_40_s) {
  RecordingSink sink;
  Navigator pipeline(drive_navigator_config(drive.options), &sink);
  std::size_t seen = 0;
  feed(drive, &pipeline, [&](const RawEpoch&, Sequencer* sequencer) {
    if (++seen == 40) at_40_s(*sequencer);
  });
  return sink;
}

TEST_CASE("a restart command ends the answer; it begins again with the new filter's alignment") {
  const SyntheticDrive drive = drive_of(60.0);
  const RecordingSink sink = drive_with(drive, [](Sequencer& s) {
    s.on_command({CommandKind::kRestart, 0.0, 0.0});
  });
  double begins_s = 0.0, aligned_s = 0.0, ends_s = 0.0;
  for (const Solution& solution : sink.solutions) {
    const double t = seconds(solution.time);
    if (t < kCommand_s + 0.001) {
      ends_s = t;
      continue;
    }
    if (begins_s == 0.0) begins_s = t;
    if (aligned_s == 0.0 && solution.source != Source::kAligning) aligned_s = t;
    CHECK(solution.anchor_epoch >= 40);
  }
  const double aligned_event_s = [&] {
    for (const Event& event : sink.events)
      if (event.kind == EventKind::kAligned && seconds(event.time) > 39.5)
        return seconds(event.time);
    return 0.0;
  }();
  CHECK(ends_s == Approx(kCommand_s).margin(0.001));
  CHECK(begins_s == Approx(kCommand_s + NavigatorConfig().realtime.deadline_ekf_s).margin(0.006));
  CHECK(aligned_event_s > 40.5);
  CHECK(aligned_s > aligned_event_s);
  CHECK(sink.decisions.size() == 59);
  CHECK(sink.count(EventKind::kDeadlineMiss) == 0);
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kCommand});
}

TEST_CASE("a filter restarted because time changed says so") {
  const SyntheticDrive drive = drive_of(41.0);
  const RecordingSink sink = drive_with(drive, [&](Sequencer& sequencer) {
    for (int i = 0; i < 40; ++i) {
      ImuSample sample = drive.imu[static_cast<std::size_t>(i)];
      sample.time = sample.time.plus_seconds(7200.0);
      sequencer.on_imu(sample);
    }
  });
  const std::vector<ResetCause> causes = resets(sink);
  REQUIRE_FALSE(causes.empty());
  CHECK(causes[0] == ResetCause::kTimeBase);
}

}  // namespace
}  // namespace leonav::test
