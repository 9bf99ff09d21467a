#include "core/navigator/stages/inertial_navigator.h"

#include <limits>

#include "inertial_rig.h"
#include "support/catch.h"

namespace leonav::test {
namespace {

TEST_CASE("nothing is published before the first anchor, every sample after it") {
  InertialRig rig;
  rig.feed(0.0, 2.0);
  CHECK(rig.sink.solutions.empty());
  CHECK(rig.navigator.source() == Source::kNone);
  rig.issue(1, 2.0, 0.2);
  rig.mailbox.deliver(1, rig.anchor(1, 2.0));
  rig.feed(2.0, 2.195);
  CHECK(rig.sink.solutions.empty());  // delivered, but its time has not come
  rig.feed(2.195, 3.0);
  REQUIRE(rig.sink.solutions.size() == 161);
  CHECK(seconds_between(rig.sink.solutions[0].time, kSkyEpoch) == Approx(2.2));
  REQUIRE(rig.sink.decisions.size() == 1);
  CHECK(rig.sink.decisions[0].committed);
  CHECK(rig.sink.decisions[0].epoch == 1);
  CHECK(seconds_between(rig.sink.decisions[0].time, kSkyEpoch) == Approx(2.2));
  for (std::size_t i = 0; i < rig.sink.solutions.size(); ++i) {
    const Solution& solution = rig.sink.solutions[i];
    CHECK(solution.sequence == i + 1);
    CHECK(solution.source == Source::kEkf);
    CHECK((solution.p_e - rig.drive.truth_at(solution.time).p_e).norm() < 1e-4);
  }
}

TEST_CASE("re-propagation from an anchor equals direct mechanization, bit for bit") {
  InertialRig rig;
  const double t = 2.00123;  // inside a sample
  rig.feed(0.0, 2.1);
  rig.issue(1, t, 0.2);
  rig.mailbox.deliver(1, rig.anchor(1, t));
  rig.feed(2.1, 5.0);

  Mechanization direct;
  const Anchor anchor = rig.anchor(1, t);
  direct.reset(anchor.state);
  std::size_t next = 0;
  for (const ImuSample& sample : rig.drive.imu) {
    if (sample.time <= anchor.state.time) continue;
    if (seconds_between(sample.time, kSkyEpoch) > 5.0 + 1e-9) break;
    direct.advance(sample.start() < anchor.state.time ? split(sample, anchor.state.time).after
                                                      : sample);
    const auto& solutions = rig.sink.solutions;
    if (next >= solutions.size() || solutions[next].time != sample.time) continue;
    REQUIRE(solutions[next].p_e == direct.state().p_e);
    ++next;
  }
  CHECK(next == rig.sink.solutions.size());
  CHECK(next > 500);
}

TEST_CASE("the answer is the same whenever the anchor commits") {
  InertialRig early, late;
  for (InertialRig* rig : {&early, &late}) {
    rig->feed(0.0, 1.0);
    rig->issue(1, 1.0, rig == &early ? 0.05 : 0.9);
    rig->mailbox.deliver(1, rig->anchor(1, 1.0));
    rig->feed(1.0, 3.0);
  }
  const Solution &a = early.sink.solutions.back(), &b = late.sink.solutions.back();
  CHECK(a.time == b.time);
  CHECK(a.p_e == b.p_e);
  CHECK(a.v_n == b.v_n);
  CHECK(a.yaw == b.yaw);
  CHECK(a.sigma_p_n == b.sigma_p_n);
}

TEST_CASE("a missed epoch leaves the older anchor in use and says so") {
  InertialRig rig;
  rig.feed(0.0, 1.0);
  rig.issue(1, 1.0, 0.1);
  rig.mailbox.deliver(1, rig.anchor(1, 1.0));
  rig.feed(1.0, 2.0);
  rig.issue(2, 2.0, 0.1);  // never delivered
  rig.feed(2.0, 2.5);
  CHECK_FALSE(rig.mailbox.deliver(2, rig.anchor(2, 2.0)));  // too late now
  REQUIRE(rig.sink.decisions.size() == 2);
  CHECK_FALSE(rig.sink.decisions[1].committed);
  CHECK(rig.navigator.misses() == 1);
  CHECK(rig.sink.count(EventKind::kDeadlineMiss) == 1);
  CHECK(rig.sink.solutions.back().anchor_epoch == 1);
  CHECK(seconds_between(rig.sink.solutions.back().time, kSkyEpoch) == Approx(2.5));
  rig.issue(3, 2.5, 0.1);
  rig.mailbox.deliver(3, rig.anchor(3, 2.5));
  rig.feed(2.5, 3.0);
  CHECK(rig.sink.solutions.back().anchor_epoch == 3);
}

TEST_CASE("without new anchors the source becomes ins and the sigmas grow") {
  InertialRig rig;
  rig.feed(0.0, 1.0);
  rig.issue(1, 1.0, 0.1);
  rig.mailbox.deliver(1, rig.anchor(1, 1.0));
  rig.feed(1.0, 3.6);
  CHECK(rig.sink.solutions.back().source == Source::kEkf);
  rig.feed(3.6, 20.0);
  CHECK(rig.sink.solutions.back().source == Source::kInsOnly);
  // Position sigma 1 m, velocity 0.1 m/s, tilt 1 mrad: after 19 s sqrt(1 + 1.9^2 + 1.77^2).
  CHECK(rig.sink.solutions.back().sigma_p_n.x() == Approx(2.78).epsilon(0.02));
  // Anchors go on coming, but without GNSS in them.
  for (std::uint64_t k = 2; k < 6; ++k) {
    const double t = 18.0 + static_cast<double>(k);
    rig.issue(k, t, 0.1);
    Anchor update = rig.anchor(k, t);
    update.gnss_used = false;
    rig.mailbox.deliver(k, update);
    rig.feed(t, t + 1.0);
    CHECK(rig.sink.solutions.back().source == Source::kInsOnly);
    CHECK(rig.sink.solutions.back().anchor_epoch == k);
  }
}

TEST_CASE("a jump is in the message once, and in an event") {
  InertialRig rig;
  rig.feed(0.0, 1.0);
  rig.issue(1, 1.0, 0.1);
  rig.mailbox.deliver(1, rig.anchor(1, 1.0));
  rig.feed(1.0, 2.0);
  rig.issue(2, 2.0, 0.1);
  rig.mailbox.deliver(2, rig.anchor(2, 2.0, 7.0));
  rig.feed(2.0, 3.0);
  std::size_t jumps = 0;
  for (const Solution& solution : rig.sink.solutions) {
    if (solution.jump_m == 0.0) continue;
    ++jumps;
    CHECK(solution.jump_m == Approx(7.0).epsilon(1e-3));
    CHECK(seconds_between(solution.time, kSkyEpoch) == Approx(2.1));
  }
  CHECK(jumps == 1);
  CHECK(rig.sink.count(EventKind::kSolutionJump) == 1);
}

TEST_CASE("while aligning the anchor is extrapolated at constant velocity") {
  InertialRig rig;
  rig.feed(0.0, 1.0);
  rig.issue(1, 1.0, 0.1);
  Anchor update = rig.anchor(1, 1.0);
  update.has_attitude = false;
  rig.mailbox.deliver(1, update);
  rig.feed(1.0, 2.0);
  const Solution& last = rig.sink.solutions.back();
  CHECK(last.source == Source::kAligning);
  CHECK_FALSE(last.has_attitude);
  CHECK((last.p_e - (update.state.p_e + update.state.v_e)).norm() < 1e-6);
}

TEST_CASE("the solution rate is bounded by data time") {
  for (const auto& [rate_hz, expected] : {std::pair(200.0, 401), {100.0, 201}, {10.0, 21}}) {
    NavigatorConfig config;
    config.solution_rate_hz = rate_hz;
    InertialRig rig(5.0, config);
    rig.feed(0.0, 1.0);
    rig.issue(1, 1.0, 0.0);
    rig.mailbox.deliver(1, rig.anchor(1, 1.0));
    rig.feed(1.0, 3.005);
    CHECK(static_cast<int>(rig.sink.solutions.size()) == Approx(expected).margin(1));
  }
}

TEST_CASE(
    "holes are bridged; time that runs backwards starts over with a decision for each epoch") {
  InertialRig rig;
  rig.feed(0.0, 1.0);
  rig.issue(1, 1.0, 0.1);
  rig.mailbox.deliver(1, rig.anchor(1, 1.0));
  rig.feed(1.0, 2.0);
  const double before = rig.sink.solutions.back().sigma_p_n.norm();
  rig.feed(5.0, 6.0);
  const Solution after = rig.sink.solutions.back();
  CHECK(seconds_between(after.time, kSkyEpoch) == Approx(6.0));
  const double error = (after.p_e - rig.drive.truth_at(after.time).p_e).norm();
  CHECK(error < 3.0 * after.sigma_p_n.norm());
  CHECK(after.sigma_p_n.norm() > 5.0 * before);

  rig.issue(2, 6.0, 0.1);
  rig.issue(3, 6.0, 0.2);
  rig.mailbox.deliver(2, rig.anchor(2, 6.0));
  const std::size_t published = rig.sink.solutions.size();
  rig.feed(3.0, 4.0);
  CHECK(rig.sink.decisions.size() == 3);
  CHECK(rig.sink.decisions[1].committed);
  CHECK_FALSE(rig.sink.decisions[2].committed);
  CHECK(rig.sink.solutions.size() == published);  // no anchor in this time yet
  rig.issue(4, 4.0, 0.1);
  rig.mailbox.deliver(4, rig.anchor(4, 4.0));
  rig.feed(4.0, 5.0);
  CHECK(rig.sink.solutions.back().anchor_epoch == 4);
}

TEST_CASE("an anchor older than the kept samples is refused, the answer goes on") {
  InertialRig rig(60.0);
  rig.feed(0.0, 1.0);
  rig.issue(1, 1.0, 0.1);
  rig.mailbox.deliver(1, rig.anchor(1, 1.0));
  rig.feed(1.0, 2.0);
  rig.issue(2, 2.0, 40.0);  // decided 8,000 samples later; 4,096 are kept
  rig.mailbox.deliver(2, rig.anchor(2, 2.0, 100.0));
  rig.feed(2.0, 50.0);
  CHECK(rig.sink.decisions.size() == 2);
  CHECK(rig.sink.count(EventKind::kCapacity) == 1);
  CHECK(rig.sink.solutions.back().anchor_epoch == 1);
  CHECK((rig.sink.solutions.back().p_e - rig.drive.truth_at(rig.sink.solutions.back().time).p_e)
            .norm() < 0.05);
}

TEST_CASE("epochs that pile up while the IMU stands still are each decided once") {
  InertialRig rig;
  rig.feed(0.0, 1.0);
  for (std::uint64_t k = 1; k <= 200; ++k) {
    rig.issue(k, 1.0, 0.1);
    CHECK(rig.mailbox.deliver(k, rig.anchor(k, 1.0)));
  }
  rig.feed(1.0, 2.0);
  REQUIRE(rig.sink.decisions.size() == 200);
  for (std::size_t i = 0; i < 200; ++i) CHECK(rig.sink.decisions[i].epoch == i + 1);
  CHECK(rig.sink.solutions.back().anchor_epoch == 200);
}

TEST_CASE("without samples each anchor is an answer, and samples of before are none") {
  InertialRig rig;
  const auto time_without_imu = [&](double t) {
    rig.navigator.process(TimeWithoutImu{kSkyEpoch.plus_seconds(t)});
  };
  rig.feed(0.0, 2.0);
  rig.issue(1, 2.0, 0.03);
  rig.mailbox.deliver(1, rig.anchor(1, 2.0));
  rig.feed(2.0, 2.1);
  const std::size_t before = rig.sink.solutions.size();
  time_without_imu(16.0);
  CHECK(rig.sink.solutions.size() == before);
  rig.issue(2, 16.0, 0.03);
  rig.mailbox.deliver(2, rig.anchor(2, 16.0, 0.5));
  time_without_imu(16.02);  // its deadline has not come
  CHECK(rig.sink.solutions.size() == before);
  time_without_imu(17.0);
  REQUIRE(rig.sink.solutions.size() == before + 1);
  CHECK(rig.sink.solutions.back().time == kSkyEpoch.plus_seconds(16.0));
  CHECK(rig.sink.solutions.back().p_e == rig.anchor(2, 16.0, 0.5).state.p_e);
  CHECK(rig.sink.solutions.back().source == Source::kEkf);
  CHECK(rig.sink.solutions.back().sigma_p_n.norm() == Approx(std::sqrt(3.0)).epsilon(1e-6));
  rig.feed(15.0, 16.0);
  CHECK(rig.sink.solutions.size() == before + 1);
  rig.feed(16.0, 18.0);
  REQUIRE(rig.sink.solutions.size() == before + 401);
  for (std::size_t i = 1; i < rig.sink.solutions.size(); ++i) {
    const Solution& solution = rig.sink.solutions[i];
    REQUIRE(solution.time > rig.sink.solutions[i - 1].time);
    CHECK((solution.p_e - rig.drive.truth_at(solution.time).p_e).norm() < 0.6);
  }
  CHECK(rig.sink.count(EventKind::kSolutionJump) == 0);
  CHECK(rig.sink.count(EventKind::kDeadlineMiss) == 0);
}

TEST_CASE("a solution that is no number is never published; the next anchor answers again") {
  for (const double push : {1e160, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
    CAPTURE(push);
    InertialRig rig;
    rig.feed(0.0, 2.0);
    rig.issue(1, 2.0, 0.2);
    rig.mailbox.deliver(1, rig.anchor(1, 2.0));
    rig.feed(2.0, 3.0);
    const std::size_t before = rig.sink.solutions.size();
    CHECK(before == 161);
    ImuSample hostile = rig.drive.imu[600];
    hostile.delta_velocity_b.setConstant(push);
    rig.navigator.process(hostile);
    rig.feed(3.005, 4.0);
    CHECK(rig.sink.solutions.size() == before);
    CHECK(rig.navigator.source() == Source::kNone);
    REQUIRE(rig.sink.count(EventKind::kFilterReset) == 1);
    CHECK(rig.sink.events.back().code == static_cast<int>(ResetCause::kNotFinite));
    rig.issue(2, 4.0, 0.2);
    rig.mailbox.deliver(2, rig.anchor(2, 4.0));
    rig.feed(4.0, 5.0);
    CHECK(rig.sink.solutions.size() == before + 161);
    for (const Solution& solution : rig.sink.solutions) {
      CHECK(is_finite(solution));
      CHECK((solution.p_e - rig.drive.truth_at(solution.time).p_e).norm() < 0.01);
    }
  }
}

}  // namespace
}  // namespace leonav::test
