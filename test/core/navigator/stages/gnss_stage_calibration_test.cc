// When a start takes the calibration of an earlier run, and what it does to the first seconds.
#include <algorithm>
#include <memory>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

double true_heading(const SyntheticDrive& drive) {
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(drive.options.start);
  return euler_from_rotation(C_ne * SyntheticPath(drive.options).state(0.0).q_eb.toRotationMatrix())
      .yaw;
}

// Of ten minutes before the drive, with errors as unknown as configured.
Checkpoint checkpoint_of(const SyntheticDrive& drive, const NavigatorConfig& config) {
  Checkpoint checkpoint;
  checkpoint.time = kSkyEpoch.plus_seconds(-600.0);
  checkpoint.antenna_p_e = SyntheticPath(drive.options).antenna_p_e(0.0);
  checkpoint.antenna_sigma = 1.0;
  checkpoint.heading = true_heading(drive);
  checkpoint.heading_sigma = 0.05;
  checkpoint.gyro_bias_sigma = config.imu.gyro_bias.sigma;
  Calibration& calibration = checkpoint.calibration.emplace();
  calibration.accel_bias_sigma.setConstant(config.imu.accel_bias.sigma);
  calibration.gyro_scale_sigma.setConstant(config.imu.gyro_scale.sigma);
  calibration.accel_scale_sigma.setConstant(config.imu.accel_scale.sigma);
  return checkpoint;
}

int told(const RecordingSink& sink, CheckpointUse use) {
  return static_cast<int>(
      std::count_if(sink.events.begin(), sink.events.end(), [&](const Event& event) {
        return event.kind == EventKind::kCheckpoint && event.code == static_cast<std::uint8_t>(use);
      }));
}

}  // namespace

TEST_CASE("an epoch of another week that starts no filter leaves the calibration to the next") {
  const SyntheticDrive drive = drive_of(8.0);
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.alignment.initial_heading = true_heading(drive);
  RecordingSink sink;
  TimedMailbox<Anchor> mailbox;
  GnssStage stage(config, &mailbox, nullptr, &sink);
  for (const Ephemeris& ephemeris : drive.ephemerides) stage.process(GnssWork(ephemeris));
  stage.process(GnssWork(checkpoint_of(drive, config)));
  std::uint64_t index = 0;
  const auto process = [&](EpochWork* work) {
    work->index = ++index;
    mailbox.open(index);
    stage.process(GnssWork(*work));
    Anchor anchor;
    REQUIRE(mailbox.take(index, &anchor));
  };
  auto early = std::make_unique<EpochWork>();
  early->raw = drive.epochs.front();
  early->time = early->raw.time = drive.epochs.front().time.plus_seconds(-7.0 * 86400.0);
  process(early.get());
  REQUIRE_FALSE(stage.ekf().initialized());
  std::size_t next = 0;
  for (const RawEpoch& raw : drive.epochs) {
    auto work = std::make_unique<EpochWork>();
    work->raw = raw;
    while (next < drive.imu.size() && drive.imu[next].time <= raw.time)
      work->block.push_back(drive.imu[next++]);
    work->time = work->block.back().time;
    process(work.get());
  }
  REQUIRE(stage.ekf().has_attitude());
  CHECK(told(sink, CheckpointUse::kCalibrationOld) == 0);
  CHECK(told(sink, CheckpointUse::kCalibrationUsed) == 1);
}

TEST_CASE("parked with an accelerometer bias, a start with its calibration is not the worse") {
  SyntheticDriveOptions options;
  options.duration_s = 12.0;
  options.standstill_s = 60.0;
  options.accel_bias_b = {0.15, 0.0, 0.0};
  const SyntheticDrive drive = synthetic_drive(options);
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.imu.accel_bias = {0.2, 1000.0};
  config.alignment.initial_heading = true_heading(drive);
  Checkpoint checkpoint = checkpoint_of(drive, config);
  checkpoint.calibration->accel_bias_b = options.accel_bias_b;
  checkpoint.calibration->accel_bias_sigma.setConstant(0.01);
  // The largest velocity of the first five seconds with an attitude.
  const auto worst_m_s = [&](bool calibrated) {
    RecordingSink sink;
    Navigator navigator(config, &sink);
    if (calibrated) navigator.sequencer().on_checkpoint(checkpoint);
    feed(drive, &navigator);
    CHECK(told(sink, CheckpointUse::kCalibrationUsed) == (calibrated ? 1 : 0));
    GpsTime first;
    double worst = 0.0;
    for (const Solution& solution : sink.solutions) {
      if (!solution.has_attitude) continue;
      if (!first.is_set()) first = solution.time;
      if (seconds_between(solution.time, first) <= 5.0)
        worst = std::max(worst, solution.v_n.norm());
    }
    REQUIRE(first.is_set());
    return worst;
  };
  CHECK(worst_m_s(true) <= worst_m_s(false) + 0.005);
}

}  // namespace leonav::test
