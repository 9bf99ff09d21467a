// A heading from outside, by configuration or command.
#include <numbers>
#include <optional>
#include <utility>

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

// Feeds the drive, and calls `tell` once, before the first epoch from 50 s on.
template <typename Tell>
void feed_and_tell(const SyntheticDrive& drive, Navigator* pipeline, Tell tell) {
  bool told = false;
  feed(drive, pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
    const double t = seconds(raw.time);
    if (told || t < 50.0) return;
    told = true;
    tell(t, sequencer);
  });
}

TEST_CASE("a restart in mid-drive aligns again and is where it was; a heading spares the wait") {
  const SyntheticDrive drive = drive_of(90.0);
  const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  for (const bool heading_given : {false, true}) {
    CAPTURE(heading_given);
    RecordingSink sink;
    Navigator pipeline(config, &sink);
    feed(drive, &pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
      const double t = seconds(raw.time);
      if (std::abs(t - 50.0) >= 0.5) return;
      sequencer->on_command({CommandKind::kRestart, 0.0, 0.0});
      if (heading_given) {
        sequencer->on_command({CommandKind::kSetHeading, heading_at(drive, t), 0.05});
      }
    });
    CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kCommand});
    CHECK(sink.count(EventKind::kAligned) == 2);
    CHECK(sink.epochs.size() == 89);
    CHECK(sink.epochs.back().solution.has_attitude);
    CHECK(worst_error(sink, drive, 75.0, 90.0) < 1.0);
  }
}

TEST_CASE("commands are answered; a heading across the motion is refused, a reversed one is not") {
  const SyntheticDrive drive = drive_of(90.0);
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.alignment.heading_watch = true;  // it drives along its axis
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  feed_and_tell(drive, &pipeline, [&](double t, Sequencer* sequencer) {
    const double heading = heading_at(drive, t);
    const auto command = [&](double value, std::optional<std::uint64_t> sequence) {
      Command one{CommandKind::kSetHeading, value, 0.05};
      one.sequence = sequence;
      sequencer->on_command(one);
    };
    command(heading + 1.5, 7);
    command(heading + 1.5, std::nullopt);  // refused as well, and nobody is told
    command(heading + std::numbers::pi, 8);
    command(heading, 9);
  });
  std::vector<std::pair<int, double>> answers;
  for (const Event& event : sink.events)
    if (event.kind == EventKind::kCommand) answers.emplace_back(event.code, event.value);
  CHECK(answers == std::vector<std::pair<int, double>>{{1, 7.0}, {0, 8.0}, {0, 9.0}});
  CHECK(worst_error(sink, drive, 60.0, 90.0) < 1.0);
}

TEST_CASE("on wheels less of a side slip is believed, the faster it drives") {
  const auto is_refused = [](double off, double turn_rate, bool on_wheels) {
    SyntheticDriveOptions options;
    options.duration_s = 60.0;
    options.turn_rate_rad_s = turn_rate;
    const SyntheticDrive drive = synthetic_drive(options);
    NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
    config.alignment.heading_watch = true;
    config.alignment.max_reverse_speed_m_s = on_wheels ? 5.0 : 0.0;
    RecordingSink sink;
    Navigator pipeline(config, &sink);
    feed_and_tell(drive, &pipeline, [&](double t, Sequencer* sequencer) {
      Command one{CommandKind::kSetHeading, heading_at(drive, t) + off, 0.01};
      one.sequence = 1;
      sequencer->on_command(one);
    });
    REQUIRE(sink.count(EventKind::kCommand) == 1);
    for (const Event& event : sink.events)
      if (event.kind == EventKind::kCommand) return event.code == 1;
    return false;
  };
  constexpr double kFast = 0.08, kSlow = 0.035;  // 8 to 11 m/s, 3.5 to 5
  CHECK_FALSE(is_refused(0.4, kFast, true));
  CHECK(is_refused(0.7, kFast, true));
  CHECK_FALSE(is_refused(0.7, kSlow, true));
  CHECK_FALSE(is_refused(0.7, kFast, false));
  CHECK(is_refused(0.9, kFast, false));
}

TEST_CASE("a commanded heading holds when it comes, and not at the epoch before, in a turn") {
  SyntheticDriveOptions options;
  options.duration_s = 90.0;
  options.turn_rate_rad_s = 0.3;
  const SyntheticDrive drive = synthetic_drive(options);
  const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  const double given_s = 60.065;  // the newest sample when the epoch of 60 s comes
  REQUIRE(std::abs(wrap_to_pi(heading_at(drive, given_s) - heading_at(drive, 59.0))) > 0.1);
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  bool told = false;
  feed(drive, &pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
    if (told || seconds(raw.time) < 59.5) return;
    told = true;
    sequencer->on_command({CommandKind::kSetHeading, heading_at(drive, given_s), 1e-3});
  });
  for (const EpochReport& report : sink.epochs) {
    const double t = seconds(report.time);
    if (t < 59.5 || t > 65.5) continue;
    CAPTURE(t, report.solution.yaw, heading_at(drive, t));
    CHECK(std::abs(wrap_to_pi(report.solution.yaw - heading_at(drive, t))) < 1e-3);
  }
  CHECK(sink.count(EventKind::kAligned) == 2);  // the start, and the command
}

TEST_CASE("a heading that waits for its samples is forgotten by a restart") {
  const SyntheticDrive drive = drive_of(90.0);
  const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  feed(drive, &pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
    const double t = seconds(raw.time);
    if (std::abs(t - 50.0) >= 0.5) return;
    sequencer->on_command({CommandKind::kSetHeading, heading_at(drive, t) + 1.0, 0.05});
    sequencer->on_command({CommandKind::kRestart});
  });
  for (const EpochReport& report : sink.epochs) {
    const double t = seconds(report.time);
    if (t < 51.5 || !report.solution.has_attitude) continue;
    CAPTURE(t);
    CHECK(std::abs(wrap_to_pi(report.solution.yaw - heading_at(drive, t))) < 0.3);
  }
}

// Restarts the filter at each of these times.
RecordingSink run_with_restarts(const SyntheticDrive& drive, const NavigatorConfig& config,
                                const std::vector<double>& restarts_s) {
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  feed(drive, &pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
    for (const double t : restarts_s)
      if (std::abs(seconds(raw.time) - t) < 0.5)
        sequencer->on_command({CommandKind::kRestart, 0.0, 0.0});
  });
  return sink;
}

// Seconds from `since_s` to the first epoch with an attitude.
double wait_for_attitude(const RecordingSink& sink, double since_s) {
  for (const EpochReport& report : sink.epochs) {
    const double t = seconds(report.time);
    if (t > since_s + 0.5 && report.solution.has_attitude) return t - since_s;
  }
  return 1e9;
}

TEST_CASE("a configured heading aligns once, and again only while the vehicle stands there") {
  SyntheticDriveOptions options;
  options.duration_s = 90.0;
  options.standstill_s = 30.0;
  const SyntheticDrive drive = synthetic_drive(options);
  NavigatorConfig config = drive_navigator_config(options);
  config.alignment.initial_heading = heading_at(drive, 0.0);
  // At 65 s the vehicle drives in another direction than it stood.
  REQUIRE(std::abs(wrap_to_pi(heading_at(drive, 66.0) - heading_at(drive, 0.0))) > 1.0);
  const RecordingSink sink = run_with_restarts(drive, config, {15.0, 65.0});
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kCommand, ResetCause::kCommand});
  CHECK(sink.count(EventKind::kAligned) == 3);
  CHECK(wait_for_attitude(sink, 0.0) < 3.5);
  CHECK(wait_for_attitude(sink, 15.0) < 3.5);
  CHECK(wait_for_attitude(sink, 65.0) > 3.5);  // the course takes its time
  int judged = 0;
  for (const EpochReport& report : sink.epochs) {
    if (!report.solution.has_attitude) continue;
    ++judged;
    const double off = wrap_to_pi(report.solution.yaw - heading_at(drive, seconds(report.time)));
    CHECK(std::abs(off) < 4.0 * report.solution.sigma_rpy.z() + 0.002);
  }
  CHECK(judged >= 75);
  CHECK(worst_error(sink, drive, 72.0, 90.0) < 1.0);
}

TEST_CASE("a heading that was found is less certain for a while, one that was told is not") {
  SyntheticDriveOptions options;
  options.duration_s = 120.0;
  options.doppler_sigma_m_s = 0.03;
  const SyntheticDrive drive = synthetic_drive(options);
  NavigatorConfig config = drive_navigator_config(options);
  const auto sigma = [&](double since_s) {
    const RecordingSink sink = run(drive, config);
    const EpochReport* aligned = nullptr;
    for (const EpochReport& report : sink.epochs) {
      if (aligned == nullptr && report.solution.has_attitude) aligned = &report;
      if (aligned != nullptr && seconds(report.time) >= seconds(aligned->time) + since_s)
        return report.solution.sigma_rpy.z();
    }
    FAIL("not that long");
    return 0.0;
  };
  config.alignment.settling_s = 20.0;
  for (const bool told : {false, true}) {
    CAPTURE(told);
    config.alignment.initial_heading.reset();
    if (told) config.alignment.initial_heading = heading_at(drive, 0.0);
    config.alignment.settling_random_walk = 0.0;
    const double plain = sigma(15.0), plain_later = sigma(60.0);
    config.alignment.settling_random_walk = 0.01;
    if (told) {
      CHECK(sigma(15.0) == plain);
    } else {
      CHECK(sigma(15.0) > 2.0 * plain);
      CHECK(sigma(60.0) < 1.5 * plain_later);
    }
  }
}

double error_at_end(const RecordingSink& sink, const SyntheticDrive& drive) {
  const EpochReport& last = sink.epochs.back();
  REQUIRE(last.solution.has_attitude);
  return wrap_to_pi(last.solution.yaw - heading_at(drive, seconds(last.time)));
}

TEST_CASE(
    "a heading that was told wrongly is noticed once the vehicle drives, a right one is not") {
  SyntheticDriveOptions options;
  options.duration_s = 70.0;
  options.epoch_interval_s = GENERATE(1.0, 0.2);
  options.doppler_sigma_m_s = 0.03;
  options.code_sigma_m = 0.5;
  CAPTURE(options.epoch_interval_s);
  const SyntheticDrive drive = synthetic_drive(options);
  NavigatorConfig config = drive_navigator_config(drive.options);
  config.alignment.velocity_matching = config.alignment.heading_watch = true;
  config.alignment.max_reverse_speed_m_s = 5.0;
  config.alignment.lever_arm_b = options.lever_arm_b;
  for (const double off_deg : {0.0, 3.0, -40.0, 90.0, -135.0, 180.0}) {
    CAPTURE(off_deg);
    const double off = off_deg * 3.14159265358979 / 180.0;
    config.alignment.initial_heading = wrap_to_pi(heading_at(drive, 0.0) + off);
    const RecordingSink sink = run(drive, config);
    int found = 0;
    for (const Event& event : sink.events) {
      if (event.kind != EventKind::kFilterReset) continue;
      CHECK(event.code == static_cast<std::uint8_t>(ResetCause::kHeading));
      CHECK(seconds(event.time) - options.standstill_s < 15.0);
      ++found;
    }
    // Within some of the sigmas it was told with the filter finds back by itself.
    if (std::abs(off_deg) < 10.0) CHECK(found == 0);
    if (std::abs(off_deg) > 60.0) CHECK(found == 1);
    CHECK(std::abs(error_at_end(sink, drive)) < 0.03);
  }
}

}  // namespace
}  // namespace leonav::test
