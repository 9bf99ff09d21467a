// Numbers that overflow.
#include "core/navigator/solution.h"
#include "stage_drive.h"
#include "support/catch.h"

namespace leonav::test {
namespace {

TEST_CASE("numbers that overflow never reach the navigator, and the filter comes back") {
  const double push = GENERATE(1e300, 1e160);
  CAPTURE(push);
  const SyntheticDrive drive = drive_of(60.0);
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.alignment.initial_heading = 0.0;
  RecordingSink sink;
  TimedMailbox<EkfUpdate> mailbox;
  GnssStage stage(config, &mailbox, &sink);
  for (const Ephemeris& ephemeris : drive.ephemerides) stage.process(GnssWork(ephemeris));
  std::size_t next = 0;
  std::uint64_t index = 0;
  int valid = 0, broken = 0;
  for (const RawEpoch& raw : drive.epochs) {
    auto work = std::make_unique<EpochWork>();
    work->index = ++index;
    work->raw = raw;
    while (next < drive.imu.size() && drive.imu[next].time <= raw.time)
      work->block.push_back(drive.imu[next++]);
    if (work->block.empty()) continue;
    work->time = work->block.back().time;
    const bool hostile = std::abs(seconds(work->time) - 20.0) < 0.5;
    if (hostile) work->block.back().delta_velocity_b.setConstant(push);
    mailbox.open(work->index);
    stage.process(GnssWork(*work));
    EkfUpdate update;
    REQUIRE(mailbox.take(work->index, &update));
    if (update.valid) {
      ++valid;
      CHECK(update.state.p_e.allFinite());
      CHECK(update.covariance.allFinite());
      CHECK(update.covariance.diagonal().maxCoeff() > 0.0);
    } else if (hostile) {
      ++broken;
    }
  }
  for (const EpochReport& report : sink.epochs) CHECK(is_finite(report.solution));
  CHECK(broken <= 1);
  CHECK(valid >= 50);
  REQUIRE(resets(sink).size() == 1);
  CHECK(resets(sink)[0] == ResetCause::kNotFinite);
  CHECK(stage.ekf().has_attitude());
}

}  // namespace
}  // namespace leonav::test
