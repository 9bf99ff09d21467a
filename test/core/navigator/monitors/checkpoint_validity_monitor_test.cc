// A run that begins from the checkpoint of an earlier one.
#include "core/navigator/interface/checkpoint.h"

#include <functional>
#include <limits>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "core/navigator/monitors/checkpoint_validity_monitor.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

constexpr double kRad = 3.14159265358979 / 180.0;

// Stands for half a minute, then drives.
SyntheticDrive parked_drive(double duration_s, double standstill_s = 30.0) {
  SyntheticDriveOptions options;
  options.duration_s = duration_s;
  options.standstill_s = standstill_s;
  options.code_sigma_m = 0.5;
  options.doppler_sigma_m_s = 0.03;
  return synthetic_drive(options);
}

// Of where the drive begins, an hour before.
Checkpoint parked_at(const SyntheticDrive& drive) {
  Checkpoint checkpoint;
  checkpoint.time = kSkyEpoch.plus_seconds(-3600.0);
  checkpoint.standing = true;
  checkpoint.antenna_p_e = SyntheticPath(drive.options).antenna_p_e(0.0);
  checkpoint.antenna_sigma = 1.0;
  checkpoint.heading = heading_at(drive, 0.0);
  checkpoint.heading_sigma = 0.2 * kRad;
  checkpoint.gyro_bias_sigma = 1e-5;
  return checkpoint;
}

RecordingSink begin_from(const Checkpoint& checkpoint, const SyntheticDrive& drive,
                         const NavigatorConfig& config) {
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  pipeline.sequencer().on_checkpoint(checkpoint);
  feed(drive, &pipeline);
  return sink;
}

// Seconds until there is an attitude.
double aligned_after(const RecordingSink& sink) {
  for (const EpochReport& report : sink.epochs)
    if (report.solution.has_attitude) return seconds(report.time);
  return 1e9;
}

// What became of the one checkpoint of the run.
CheckpointUse use_in(const RecordingSink& sink) {
  REQUIRE(sink.count(EventKind::kCheckpoint) == 1);
  for (const Event& event : sink.events)
    if (event.kind == EventKind::kCheckpoint) return static_cast<CheckpointUse>(event.code);
  return CheckpointUse::kNotNeeded;
}

TEST_CASE("a vehicle that was parked and starts again is aligned at once, without driving") {
  const SyntheticDrive drive = parked_drive(60.0);
  const NavigatorConfig config = drive_navigator_config(drive.options);
  CHECK(aligned_after(run(drive, config)) > 20.0);  // without
  const RecordingSink sink = begin_from(parked_at(drive), drive, config);
  CHECK(use_in(sink) == CheckpointUse::kUsed);
  CHECK(aligned_after(sink) < 3.5);
  CHECK(sink.count(EventKind::kAligned) == 1);
  CHECK(sink.count(EventKind::kFilterReset) == 0);
  bool first = true;
  for (const EpochReport& report : sink.epochs) {
    if (!report.solution.has_attitude) continue;
    const double off = wrap_to_pi(report.solution.yaw - heading_at(drive, seconds(report.time)));
    CHECK(std::abs(off) < 4.0 * report.solution.sigma_rpy.z() + 0.002);
    // What was 0.2 degrees then is not believed to be that now.
    if (std::exchange(first, false)) CHECK(report.solution.sigma_rpy.z() > 1.9 * kRad);
  }
  CHECK(worst_error(sink, drive, 45.0, 60.0) < 3.0);
}

TEST_CASE("a checkpoint of elsewhere, of another time or of a moving vehicle is ignored") {
  const SyntheticDrive drive = parked_drive(20.0);
  const NavigatorConfig config = drive_navigator_config(drive.options);
  const RecordingSink without = run(drive, config);
  const auto ignored = [&](const Checkpoint& checkpoint, CheckpointUse why) {
    const RecordingSink sink = begin_from(checkpoint, drive, config);
    CHECK(use_in(sink) == why);
    // Else nothing is other than without it.
    REQUIRE(sink.epochs.size() == without.epochs.size());
    for (std::size_t k = 0; k < sink.epochs.size(); ++k) {
      CHECK(sink.epochs[k].solution.p_e == without.epochs[k].solution.p_e);
      CHECK_FALSE(sink.epochs[k].solution.has_attitude);
    }
  };
  const Checkpoint good = parked_at(drive);
  Checkpoint checkpoint = good;
  const Eigen::Vector3d north =
      rotation_ecef_to_ned(drive.options.start).transpose() * Eigen::Vector3d::UnitX();
  checkpoint.antenna_p_e += 100.0 * north;
  ignored(checkpoint, CheckpointUse::kElsewhere);
  checkpoint = good;
  checkpoint.time = kSkyEpoch.plus_seconds(-config.checkpoint_max_age_s - 10.0);
  ignored(checkpoint, CheckpointUse::kOld);
  checkpoint.time = kSkyEpoch.plus_seconds(60.0);
  ignored(checkpoint, CheckpointUse::kFuture);
  checkpoint = good;
  checkpoint.standing = false;
  ignored(checkpoint, CheckpointUse::kTakenMoving);
}

TEST_CASE("a vehicle that moves or turns before its first position does not take the heading") {
  const auto without_satellites_until = [](double t, SyntheticDrive* drive) {
    std::erase_if(drive->epochs, [&](const RawEpoch& raw) { return seconds(raw.time) < t; });
  };
  // Drives off at once, and is still near the place at its first position.
  SyntheticDrive drive = parked_drive(15.0, 0.0);
  without_satellites_until(4.5, &drive);
  const NavigatorConfig config = drive_navigator_config(drive.options);
  CHECK(use_in(begin_from(parked_at(drive), drive, config)) == CheckpointUse::kMoves);
  // On a turntable while there are no satellites yet: a right angle in nine seconds.
  drive = parked_drive(20.0);
  without_satellites_until(12.0, &drive);
  for (ImuSample& sample : drive.imu) {
    const double t = seconds(sample.time);
    if (t > 2.0 && t < 11.0) sample.delta_theta_b.z() += 10.0 * kRad * sample.interval_s();
  }
  const RecordingSink turned = begin_from(parked_at(drive), drive, config);
  CHECK(use_in(turned) == CheckpointUse::kMoves);
  CHECK(aligned_after(turned) > 20.0);
  // Told once more, it is as wrong as before.
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  pipeline.sequencer().on_checkpoint(parked_at(drive));
  bool again = false;
  feed(drive, &pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
    if (seconds(raw.time) > 15.5 && !std::exchange(again, true))
      sequencer->on_checkpoint(parked_at(drive));
  });
  CHECK(sink.count(EventKind::kCheckpoint) == 2);
  CHECK(aligned_after(sink) > 20.0);
}

TEST_CASE("nor does one that turns slowly, or while its IMU is silent") {
  const auto begins = [](const std::function<void(SyntheticDrive*)>& change) {
    SyntheticDrive drive = parked_drive(20.0);
    std::erase_if(drive.epochs, [](const RawEpoch& raw) { return seconds(raw.time) < 12.0; });
    change(&drive);
    NavigatorConfig config = drive_navigator_config(drive.options);
    config.imu.gyro_bias.sigma = 1e-4;
    return use_in(begin_from(parked_at(drive), drive, config));
  };
  const auto between = [](const ImuSample& sample, double from, double to) {
    return seconds(sample.time) > from && seconds(sample.time) < to;
  };
  CHECK(begins([](SyntheticDrive*) {}) == CheckpointUse::kUsed);
  CHECK(begins([&](SyntheticDrive* drive) {
          for (ImuSample& sample : drive->imu)  // 18 degrees in all
            if (between(sample, 2.0, 11.0))
              sample.delta_theta_b.z() += 2.0 * kRad * sample.interval_s();
        }) == CheckpointUse::kMoves);
  CHECK(begins([&](SyntheticDrive* drive) {
          std::erase_if(drive->imu, [&](const ImuSample& s) { return between(s, 4.0, 6.0); });
        }) == CheckpointUse::kMoves);
}

TEST_CASE("who has told a heading knows better than a checkpoint, whenever it comes") {
  const SyntheticDrive drive = parked_drive(10.0);
  NavigatorConfig config = drive_navigator_config(drive.options);
  Checkpoint checkpoint = parked_at(drive);
  checkpoint.heading += 1.0;
  config.alignment.initial_heading = heading_at(drive, 0.0);
  const RecordingSink told = begin_from(checkpoint, drive, config);
  CHECK(use_in(told) == CheckpointUse::kNotNeeded);
  REQUIRE(told.epochs.back().solution.has_attitude);
  CHECK(std::abs(wrap_to_pi(told.epochs.back().solution.yaw - heading_at(drive, 9.0))) < 0.05);

  RecordingSink late;  // there is an attitude
  Navigator pipeline(config, &late);
  feed(drive, &pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
    if (std::abs(seconds(raw.time) - 7.0) < 0.5) sequencer->on_checkpoint(checkpoint);
  });
  CHECK(use_in(late) == CheckpointUse::kNotNeeded);
  CHECK(std::abs(wrap_to_pi(late.epochs.back().solution.yaw - heading_at(drive, 9.0))) < 0.05);
}

TEST_CASE("a filter restarted while still parked takes the checkpoint's heading again") {
  const SyntheticDrive drive = parked_drive(20.0);
  RecordingSink sink;
  Navigator pipeline(drive_navigator_config(drive.options), &sink);
  pipeline.sequencer().on_checkpoint(parked_at(drive));
  feed(drive, &pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
    if (std::abs(seconds(raw.time) - 10.0) < 0.5)
      sequencer->on_command({CommandKind::kRestart, 0.0, 0.0});
  });
  CHECK(sink.count(EventKind::kAligned) == 2);
  CHECK(sink.epochs.back().solution.has_attitude);
}

TEST_CASE("a vehicle turned in place while it was off is noticed once it drives") {
  SyntheticDriveOptions options;
  options.duration_s = 70.0;
  options.doppler_sigma_m_s = 0.03;
  options.code_sigma_m = 0.5;
  const SyntheticDrive drive = synthetic_drive(options);
  NavigatorConfig config = drive_navigator_config(drive.options);
  config.alignment.velocity_matching = config.alignment.heading_watch = true;
  config.alignment.max_reverse_speed_m_s = 5.0;
  config.alignment.lever_arm_b = options.lever_arm_b;
  for (const double off_deg : {90.0, -135.0, 180.0}) {
    CAPTURE(off_deg);
    Checkpoint checkpoint = parked_at(drive);
    checkpoint.heading = wrap_to_pi(checkpoint.heading + off_deg * kRad);
    const RecordingSink sink = begin_from(checkpoint, drive, config);
    CHECK(use_in(sink) == CheckpointUse::kUsed);
    CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kHeading});
    REQUIRE(sink.epochs.back().solution.has_attitude);
    const double end_s = seconds(sink.epochs.back().time);
    CHECK(std::abs(wrap_to_pi(sink.epochs.back().solution.yaw - heading_at(drive, end_s))) < 0.03);
  }
}

TEST_CASE("what a run leaves is what the next one can begin from") {
  const SyntheticDrive drive = parked_drive(60.0);
  const NavigatorConfig config = drive_navigator_config(drive.options);
  const RecordingSink sink = begin_from(parked_at(drive), drive, config);
  const SyntheticPath path(drive.options);
  int standing = 0, moving = 0;
  for (const EpochReport& report : sink.epochs) {
    if (report.solution.source == Source::kNone) continue;
    REQUIRE(report.checkpoint);
    const Checkpoint& left = *report.checkpoint;
    const double t = seconds(report.time);
    CHECK(left.time == report.time);
    CHECK((left.antenna_p_e - path.antenna_p_e(t)).norm() < 5.0);
    if (t < 29.0) standing += left.standing ? 1 : 0;
    if (t > 35.0) moving += left.standing ? 0 : 1;
    if (!report.solution.has_attitude) CHECK(left.heading_sigma > 3.0);  // nothing to begin from
    if (t > 5.0) CHECK(left.heading == report.solution.yaw);
  }
  CHECK(standing > 24);
  CHECK(moving > 22);
}

TEST_CASE("hostile checkpoints are counted and dropped before any stage sees them") {
  SequencerRig rig;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Checkpoint good = parked_at(parked_drive(1.0));
  Checkpoint bad = good;
  bad.heading = nan;
  rig.sequencer.on_checkpoint(bad);
  bad = good;
  bad.heading_sigma = 0.0;
  rig.sequencer.on_checkpoint(bad);
  bad = good;
  bad.antenna_p_e *= 2.0;
  rig.sequencer.on_checkpoint(bad);
  bad = good;
  bad.time = GpsTime();
  rig.sequencer.on_checkpoint(bad);
  CHECK(rig.rejected(InputFault::kNotFinite) == 1);
  CHECK(rig.rejected(InputFault::kOutOfRange) == 3);
  CHECK(rig.stages.checkpoints.empty());
  rig.sequencer.on_checkpoint(good);
  CHECK(rig.stages.checkpoints.size() == 1);
}

}  // namespace
}  // namespace leonav::test
