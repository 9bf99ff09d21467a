#include "core/navigator/navigator.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

#include "support/catch.h"
#include "support/drive/stage_drive.h"
#include "tools/common/allocations/allocation_counter.h"

namespace leonav::test {
namespace {

// Worst errors of the solutions with attitude after `from_s`.
struct Errors {
  int count = 0;
  double position = 0.0, velocity = 0.0, yaw = 0.0;
};
Errors errors_after(const RecordingSink& sink, const SyntheticDrive& drive, double from_s) {
  Errors worst;
  for (const Solution& s : sink.solutions) {
    if (seconds(s.time) < from_s || !s.has_attitude) continue;
    const NavState truth = drive.truth_at(s.time);
    const Eigen::Matrix3d C_ne = rotation_ecef_to_ned({s.latitude, s.longitude, s.height});
    const double yaw = euler_from_rotation(C_ne * truth.q_eb.toRotationMatrix()).yaw;
    ++worst.count;
    worst.position = std::max(worst.position, (s.p_e - truth.p_e).norm());
    worst.velocity = std::max(worst.velocity, (s.v_n - C_ne * truth.v_e).norm());
    worst.yaw = std::max(worst.yaw, std::abs(wrap_to_pi(s.yaw - yaw)));
  }
  return worst;
}

SyntheticDriveOptions short_drive() {
  SyntheticDriveOptions options;
  options.duration_s = 60.0;
  options.first_epoch_s = 0.737;
  return options;
}

bool same_bits(const Solution& a, const Solution& b) {
  return a.sequence == b.sequence && a.time == b.time && a.source == b.source && a.p_e == b.p_e &&
         a.v_n == b.v_n && a.roll == b.roll && a.pitch == b.pitch && a.yaw == b.yaw &&
         a.sigma_p_n == b.sigma_p_n && a.sigma_rpy == b.sigma_rpy && a.jump_m == b.jump_m &&
         a.anchor_epoch == b.anchor_epoch;
}

TEST_CASE("the whole pipeline finds the truth of a synthetic drive") {
  SyntheticDriveOptions options;
  options.duration_s = 90.0;
  const SyntheticDrive drive = synthetic_drive(options);
  RecordingSink sink;
  Navigator pipeline(drive_navigator_config(options), &sink);
  feed(drive, &pipeline);
  // The epoch at 90 s arrives after the drive's end.
  CHECK(sink.epochs.size() == 89);
  CHECK(sink.decisions.size() == 89);
  CHECK(sink.count(EventKind::kAligned) == 1);
  CHECK(sink.count(EventKind::kDeadlineMiss) == 0);
  // Noise-free measurements leave the differences of the delay models and the filter's transient.
  const Errors worst = errors_after(sink, drive, 40.0);
  CHECK(worst.count == 10'001);
  CHECK(worst.position < 0.05);
  CHECK(worst.velocity < 0.005);
  CHECK(worst.yaw < 5e-4);
  const EpochReport& last = sink.epochs.back();
  CHECK(last.satellites_used >= 10);
  CHECK(last.solution.source == Source::kEkf);
  CHECK(last.clock_m[0] == Approx((2e-5 + 5e-8 * 89.0) * kSpeedOfLight).margin(0.5));
  CHECK(std::isnan(last.clock_m[index_of(System::kLeo)]));
  for (const SatelliteReport& satellite : last.satellites) {
    if (satellite.elevation < 0.26) CHECK(satellite.reason == Reason::kLowElevation);
  }
}

TEST_CASE("with noise the errors are what the sigmas say") {
  SyntheticDriveOptions options;
  options.duration_s = 150.0;
  options.leo = true;
  options.code_sigma_m = 0.7;
  options.doppler_sigma_m_s = 0.05;
  options.angle_random_walk = 1e-4;
  options.velocity_random_walk = 1e-3;
  options.gyro_bias_b << 1e-4, -1e-4, 5e-5;
  options.accel_bias_b << 0.005, -0.005, 0.01;
  const SyntheticDrive drive = synthetic_drive(options);
  RecordingSink sink;
  Navigator pipeline(drive_navigator_config(options), &sink);
  feed(drive, &pipeline);
  const Errors worst = errors_after(sink, drive, 60.0);
  CHECK(worst.position < 4.0);
  CHECK(worst.velocity < 0.4);
  int inside = 0, count = 0;
  for (const EpochReport& report : sink.epochs) {
    if (seconds(report.time) < 60.0) continue;
    const Eigen::Vector3d error_n =
        rotation_ecef_to_ned({report.solution.latitude, report.solution.longitude, 0.0}) *
        (report.solution.p_e - drive.truth_at(report.time).p_e);
    for (int i = 0; i < 3; ++i, ++count) {
      inside += std::abs(error_n(i)) < 3.0 * report.solution.sigma_p_n(i) ? 1 : 0;
    }
  }
  CHECK(count > 250);
  CHECK(inside > 0.95 * count);
}

TEST_CASE("a run replays bit for bit, recorded misses included") {
  const SyntheticDrive drive = synthetic_drive(short_drive());
  const NavigatorConfig config = drive_navigator_config(drive.options);
  RecordingSink first, second, undisturbed;
  for (RecordingSink* sink : {&first, &second}) {
    Navigator pipeline(config, sink);
    for (const std::uint64_t epoch : {20, 21, 33})
      pipeline.record(decided(epoch, Decision::Subject::kFilter, false));
    feed(drive, &pipeline);
  }
  Navigator pipeline(config, &undisturbed);
  feed(drive, &pipeline);
  REQUIRE(first.solutions.size() == second.solutions.size());
  bool same = true;
  for (std::size_t i = 0; i < first.solutions.size(); ++i) {
    same = same && same_bits(first.solutions[i], second.solutions[i]);
  }
  CHECK(same);
  CHECK(first.count(EventKind::kDeadlineMiss) == 3);
  CHECK(undisturbed.count(EventKind::kDeadlineMiss) == 0);
  // The filter does not notice a miss, and after the next commit nobody can.
  REQUIRE(first.solutions.size() == undisturbed.solutions.size());
  CHECK(same_bits(first.solutions.back(), undisturbed.solutions.back()));
  for (const Decision& decision : first.decisions) {
    const bool missed = decision.epoch == 20 || decision.epoch == 21 || decision.epoch == 33;
    CHECK(decision.committed == !missed);
  }
}

TEST_CASE("an outage of twenty seconds: empty epochs, ins, and back without a reset") {
  SyntheticDriveOptions options = short_drive();
  options.duration_s = 90.0;
  SyntheticDrive drive = synthetic_drive(options);
  std::erase_if(drive.epochs, [](const RawEpoch& raw) {
    return seconds(raw.time) > 45.0 && seconds(raw.time) < 65.0;
  });
  RecordingSink sink;
  Navigator pipeline(drive_navigator_config(options), &sink);
  feed(drive, &pipeline);
  CHECK(pipeline.sequencer().counters().empty_epochs >= 18);
  CHECK(sink.count(EventKind::kEmptyEpoch) == 16);  // then only every 256th: counters have the rest
  CHECK(sink.count(EventKind::kFilterReset) == 0);
  int ins = 0;
  for (const Solution& s : sink.solutions) {
    const double error = (s.p_e - drive.truth_at(s.time).p_e).norm();
    ins += s.source == Source::kInsOnly ? 1 : 0;
    if (s.source == Source::kInsOnly) CHECK(error < 3.0 * s.sigma_p_n.norm());
  }
  CHECK(ins > 3000);
  CHECK(sink.solutions.back().source == Source::kEkf);
  CHECK(errors_after(sink, drive, 80.0).position < 0.3);
}

TEST_CASE("before any ephemeris every epoch still reports its satellites and why") {
  SyntheticDriveOptions options = short_drive();
  options.duration_s = 5.0;
  SyntheticDrive drive = synthetic_drive(options);
  drive.ephemerides.clear();
  RecordingSink sink;
  Navigator pipeline(drive_navigator_config(options), &sink);
  feed(drive, &pipeline);
  CHECK(sink.epochs.size() == 5);
  CHECK(sink.solutions.empty());
  for (const EpochReport& report : sink.epochs) {
    CHECK(report.solution.source == Source::kNone);
    CHECK(report.satellites_used == 0);
    REQUIRE(report.satellites.size() > 8);
    for (const SatelliteReport& satellite : report.satellites) {
      CHECK(satellite.reason == Reason::kNoEphemeris);
    }
  }
}

TEST_CASE("without IMU the GNSS stage publishes one solution per epoch") {
  const SyntheticDrive drive = synthetic_drive(short_drive());
  NavigatorConfig config = drive_navigator_config(drive.options);
  config.motion = MotionModel::kConstantVelocity;
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  feed(drive, &pipeline);
  REQUIRE(sink.solutions.size() == drive.epochs.size());
  CHECK(sink.decisions.empty());
  const SyntheticPath path(drive.options);
  for (std::size_t i = 0; i < sink.solutions.size(); ++i) {
    CHECK(sink.solutions[i].sequence == i + 1);
    CHECK(sink.solutions[i].source == Source::kEkf);
    const Eigen::Vector3d antenna = path.antenna_p_e(seconds(sink.solutions[i].time));
    CHECK((sink.solutions[i].p_e - antenna).norm() < 1.0);
  }
}

TEST_CASE("a restart forgets, a heading from outside aligns at a standstill") {
  SyntheticDriveOptions options = short_drive();
  options.standstill_s = 1000.0;
  const SyntheticDrive drive = synthetic_drive(options);
  RecordingSink sink;
  Navigator pipeline(drive_navigator_config(options), &sink);
  const double truth_yaw = std::atan2(100.0, 100.0);
  std::size_t seen = 0;
  feed(drive, &pipeline, [&](const RawEpoch&, Sequencer* sequencer) {
    if (++seen == 10) sequencer->on_command({CommandKind::kSetHeading, truth_yaw, 0.02});
    if (seen == 30) sequencer->on_command({CommandKind::kSetHeading, truth_yaw + 0.1, 0.02});
    if (seen == 40) sequencer->on_command({CommandKind::kRestart, 0.0, 0.0});
  });
  CHECK_FALSE(sink.epochs[8].solution.has_attitude);
  REQUIRE(sink.epochs[20].solution.has_attitude);
  CHECK(sink.epochs[20].solution.yaw == Approx(truth_yaw).margin(0.02));
  CHECK(sink.epochs[30].solution.yaw == Approx(truth_yaw + 0.1).margin(0.03));
  CHECK(sink.count(EventKind::kFilterReset) == 1);
  CHECK(sink.epochs.back().solution.source == Source::kEkf);
  CHECK(errors_after(sink, drive, 55.0).position < 1.5);
}

// A sink that copies into storage it has beforehand.
struct CountingSink : OutputSink {
  std::size_t solutions = 0, epochs = 0;
  void on_solution(const Solution&) override { ++solutions; }
  void on_epoch(const EpochReport&) override { ++epochs; }
  void on_event(const Event&) override {}
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}
};

TEST_CASE("once constructed, the stages allocate nothing") {
  SyntheticDriveOptions options = short_drive();
  SyntheticDrive drive = synthetic_drive(options);
  std::erase_if(drive.epochs, [](const RawEpoch& raw) {
    return seconds(raw.time) > 30.0 && seconds(raw.time) < 40.0;
  });
  CountingSink sink;
  Navigator pipeline(drive_navigator_config(options), &sink);
  start_counting_allocations();
  feed(drive, &pipeline);
  pipeline.sequencer().on_command({CommandKind::kSetHeading, 0.5, 0.1});
  pipeline.sequencer().on_command({CommandKind::kRestart, 0.0, 0.0});
  const std::size_t allocations = stop_counting_allocations();
  CHECK(sink.epochs >= 60);
  CHECK(sink.solutions > 9000);
  CHECK(allocations == 0);
  start_counting_allocations();
  int* volatile one = new int(1);  // volatile: or the compiler leaves the pair out
  delete one;
  CHECK(stop_counting_allocations() == 1);  // the counter counts
}

}  // namespace
}  // namespace leonav::test
