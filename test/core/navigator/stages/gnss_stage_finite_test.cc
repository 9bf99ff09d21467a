// Numbers that overflow.
#include "core/navigator/interface/solution_conversion.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

TEST_CASE("numbers that overflow never reach the navigator, and the filter comes back") {
  const double push = GENERATE(1e300, 1e160);
  CAPTURE(push);
  const SyntheticDrive drive = drive_of(60.0);
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.alignment.initial_heading = 0.0;
  RecordingSink sink;
  TimedMailbox<Anchor> mailbox;
  GnssStage stage(config, &mailbox, nullptr, &sink);
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
    Anchor update;
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

// Between what the filter can hold and what overflows everywhere lies a narrow band: its covariance
// is finite in ECEF, but no longer when rotated to north, east, down. An absurd turn that makes the
// attitude's covariance huge, then an absurd push across it reach that band; steps of a fiftieth do
// not miss it. Epochs without GNSS leave it standing.
TEST_CASE("a filter that is finite while its solution is not is dropped before it is published") {
  const SyntheticDrive drive = drive_of(8.0);
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.alignment.initial_heading = 0.0;
  int held = 0, dropped = 0;
  for (double push = 1e78; push < 4e79; push *= 1.02) {
    CAPTURE(push);
    RecordingSink sink;
    TimedMailbox<Anchor> mailbox;
    GnssStage stage(config, &mailbox, nullptr, &sink);
    for (const Ephemeris& ephemeris : drive.ephemerides) stage.process(GnssWork(ephemeris));
    Anchor update;
    std::size_t next = 0;
    const auto process = [&](std::uint64_t index, bool gnss, const Eigen::Vector3d& turn_b,
                             const Eigen::Vector3d& push_b) {
      auto work = std::make_unique<EpochWork>();
      work->index = index;
      work->empty = !gnss;
      work->raw = drive.epochs[index];
      while (next < drive.imu.size() && drive.imu[next].time <= work->raw.time)
        work->block.push_back(drive.imu[next++]);
      work->time = work->block.back().time;
      work->block.back().delta_theta_b += turn_b;
      work->block.back().delta_velocity_b += push_b;
      mailbox.open(index);
      stage.process(GnssWork(*work));
      REQUIRE(mailbox.take(index, &update));
    };
    const Eigen::Vector3d nothing = Eigen::Vector3d::Zero();
    for (std::uint64_t k = 1; k <= 3; ++k) process(k, true, nothing, nothing);
    process(4, false, Eigen::Vector3d::Constant(1e79), nothing);
    REQUIRE(stage.ekf().has_attitude());
    // Equal in all axes of ECEF, where its cross product with an error spreads most evenly.
    process(5, false, nothing,
            stage.ekf().state().q_eb.conjugate() * Eigen::Vector3d::Constant(push));
    CHECK(is_finite(sink.epochs.back().solution));
    CHECK(update.valid == stage.ekf().initialized());
    CHECK(resets(sink).size() == (update.valid ? 0U : 1U));
    (update.valid ? held : dropped) += 1;
  }
  CHECK(held > 10);
  CHECK(dropped > 10);
}

}  // namespace
}  // namespace leonav::test
