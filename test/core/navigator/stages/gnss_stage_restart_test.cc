// When the filter is started anew, and when it is not.
#include "core/gnss/signals/band_plan.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

TEST_CASE("a wrong prediction restarts the filter, which keeps its attitude the first time") {
  const SyntheticDrive there = drive_of(120.0, 3'000.0);
  const SyntheticDrive drive = carried_away(120.0, 60.0, 3'000.0);
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.ekf.prediction_suspect_ratio = kNeverWiden;
  const RecordingSink sink = run(drive, config);
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kPrediction});
  CHECK(sink.count(EventKind::kAligned) == 1);
  CHECK(worst_error(sink, drive, 40.0, 59.5) < 0.5);
  // Two suspect epochs are believed to be the measurements' fault, the third is not.
  CHECK(worst_error(sink, there, 60.0, 61.5) > 2'900.0);
  CHECK(worst_error(sink, there, 65.0, 120.0) < 5.0);
  for (const EpochReport& report : sink.epochs) {
    if (seconds(report.time) > 62.5) CHECK(report.solution.has_attitude);
  }
  // Jumps say so.
  CHECK(sink.count(EventKind::kSolutionJump) >= 1);
  const auto jumped = std::any_of(sink.solutions.begin(), sink.solutions.end(),
                                  [](const Solution& s) { return s.jump_m > 2'900.0; });
  CHECK(jumped);
}

TEST_CASE("an attitude that still settles goes on settling in the filter that is started anew") {
  const SyntheticDrive drive = carried_away(120.0, 60.0, 3'000.0);
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.ekf.prediction_suspect_ratio = kNeverWiden;
  const auto sigma_at_85 = [&](double random_walk, double settling_s) {
    config.alignment.settling_random_walk = random_walk;
    config.alignment.settling_s = settling_s;
    const RecordingSink sink = run(drive, config);
    CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kPrediction});
    for (const EpochReport& report : sink.epochs)
      if (seconds(report.time) >= 85.0) return report.solution.sigma_rpy.z();
    return 0.0;
  };
  const double settled_before = sigma_at_85(0.01, 30.0);
  CHECK(sigma_at_85(0.01, 100.0) > 1.5 * settled_before);
}

TEST_CASE("a second wrong prediction within a minute gives up the attitude too") {
  SyntheticDrive drive = carried_away(120.0, 50.0, 3'000.0);
  const SyntheticDrive there = drive_of(120.0, 6'000.0);
  for (std::size_t k = 0; k < drive.epochs.size(); ++k) {
    if (seconds(drive.epochs[k].time) >= 70.0) drive.epochs[k] = there.epochs[k];
  }
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.ekf.prediction_suspect_ratio = kNeverWiden;
  const RecordingSink sink = run(drive, config);
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kPrediction, ResetCause::kPrediction});
  CHECK(sink.count(EventKind::kAligned) == 2);
  CHECK(worst_error(sink, there, 75.0, 120.0) < 5.0);
  CHECK(sink.epochs.back().solution.has_attitude);
}

TEST_CASE("a wrong prediction soon after a gap of the IMU is the first one: the attitude is kept") {
  SyntheticDrive drive = carried_away(120.0, 80.0, 3'000.0);
  std::erase_if(drive.imu, [](const ImuSample& sample) {
    return seconds(sample.time) > 40.0 && seconds(sample.time) < 44.0;
  });
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.ekf.prediction_suspect_ratio = kNeverWiden;
  const RecordingSink sink = run(drive, config);
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kImuGap, ResetCause::kPrediction});
  CHECK(sink.count(EventKind::kAligned) == 2);
  for (const EpochReport& report : sink.epochs) {
    if (seconds(report.time) > 82.5) CHECK(report.solution.has_attitude);
  }
}

TEST_CASE("without robust weights a vehicle carried away is found again, widening or restarting") {
  const SyntheticDrive there = drive_of(120.0, 3'000.0);
  const SyntheticDrive drive = carried_away(120.0, 60.0, 3'000.0);
  for (const double widen : {3.0, kNeverWiden}) {
    CAPTURE(widen);
    NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
    config.ekf.robust.enabled = false;
    config.ekf.prediction_suspect_ratio = widen;
    const RecordingSink sink = run(drive, config);
    CHECK(worst_error(sink, there, 70.0, 120.0) < 5.0);
  }
}

TEST_CASE("a filter locked out of all Dopplers is started anew, with codes good or not") {
  SyntheticDrive drive = drive_of(90.0, 0.0, false);
  // The oscillator's frequency steps by 50 m/s. Codes follow, as clock jumps.
  for (RawEpoch& raw : drive.epochs) {
    const double t = seconds(raw.time) - 40.0;
    if (t <= 0.0) continue;
    for (SignalObservation& o : raw.observations) {
      o.pseudorange_m += 50.0 * t;
      o.doppler_hz -= 50.0 / BandPlan().wavelength_m(o.satellite.system, o.code.band);
    }
  }
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kConstantVelocity);
  config.ekf.prediction_suspect_ratio = kNeverWiden;
  const RecordingSink sink = run(drive, config);
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kPrediction});
  int dopplers = 0;
  for (const AidingReport& aiding : sink.epochs.back().aiding)
    if (aiding.observable == Observable::kDoppler && aiding.weight_factor > 0.5) ++dopplers;
  CHECK(dopplers >= 6);
  CHECK(worst_error(sink, drive, 50.0, 90.0) < 3.0);
}

TEST_CASE("a point solution that nothing checks does not overthrow the filter at once") {
  SyntheticDrive drive = carried_away(85.0, 60.0, 3'000.0);
  // Four satellites of one system are left: any four codes fit a position.
  for (RawEpoch& raw : drive.epochs) {
    if (seconds(raw.time) < 59.5) continue;
    std::vector<SatelliteId> seen;
    const auto surplus = [&](const SignalObservation& o) {
      if (o.satellite.system != System::kGps) return true;
      if (std::find(seen.begin(), seen.end(), o.satellite) == seen.end())
        seen.push_back(o.satellite);
      return seen.size() > 5;
    };
    auto& all = raw.observations;
    all.erase(std::remove_if(all.begin(), all.end(), surplus), all.end());
  }
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  config.ekf.prediction_suspect_ratio = kNeverWiden;
  CHECK(resets(run(drive, config)).empty());
}

TEST_CASE("as configured, the filter follows a vehicle that was carried away without a restart") {
  const SyntheticDrive there = drive_of(120.0, 3'000.0);
  const SyntheticDrive drive = carried_away(120.0, 60.0, 3'000.0);
  const RecordingSink sink =
      run(drive, drive_navigator_config(drive.options, MotionModel::kInertial));
  CHECK(worst_error(sink, there, 70.0, 120.0) < 5.0);
}

TEST_CASE("after an outage that leaves the position unknown, the first epoch starts anew") {
  SyntheticDrive drive = drive_of(900.0, 0.0, false);
  std::erase_if(drive.epochs, [](const RawEpoch& raw) {
    return seconds(raw.time) > 60.5 && seconds(raw.time) < 799.5;
  });
  const NavigatorConfig config =
      drive_navigator_config(drive.options, MotionModel::kConstantVelocity);
  const RecordingSink sink = run(drive, config);
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kOutage});
  CHECK(sink.solutions.size() == drive.epochs.size());
  CHECK(worst_error(sink, drive, 799.5, 900.0) < 3.0);
}

TEST_CASE("an outage that ends in faults does not start anew from them") {
  SyntheticDrive drive = drive_of(830.0, 0.0, false);
  std::erase_if(drive.epochs, [](const RawEpoch& raw) {
    return seconds(raw.time) > 60.5 && seconds(raw.time) < 799.5;
  });
  // Three satellites left: no position, and every one says why.
  for (RawEpoch& raw : drive.epochs) {
    if (seconds(raw.time) < 799.5 || seconds(raw.time) > 805.5) continue;
    const SatelliteId third =
        raw.observations[std::min<std::size_t>(6, raw.observations.size() - 1)].satellite;
    const auto end = std::find_if(raw.observations.begin(), raw.observations.end(),
                                  [&](const auto& o) { return third < o.satellite; });
    raw.observations.erase(end, raw.observations.end());
  }
  const RecordingSink sink =
      run(drive, drive_navigator_config(drive.options, MotionModel::kConstantVelocity));
  for (const EpochReport& report : sink.epochs) {
    const double t = seconds(report.time);
    if (t < 799.5 || t > 805.5) continue;
    CHECK(report.satellites_used == 0);
    CHECK(report.solution.sigma_p_n.norm() > 500.0);
    for (const SatelliteReport& satellite : report.satellites) {
      CHECK(satellite.reason != Reason::kUsed);
    }
  }
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kOutage});
  CHECK(worst_error(sink, drive, 806.0, 830.0) < 3.0);
}

const EpochReport& report_at(const RecordingSink& sink, double t) {
  const auto found = std::find_if(sink.epochs.begin(), sink.epochs.end(), [&](const auto& report) {
    return std::abs(seconds(report.time) - t) < 0.5;
  });
  REQUIRE(found != sink.epochs.end());
  return *found;
}

// Satellites with a carrier arc at `t`, and how many of them are still on it two epochs later.
struct Arcs {
  int all = 0, continued = 0;
};
Arcs arcs_over(const RecordingSink& sink, double t) {
  Arcs arcs;
  for (const SatelliteReport& before : report_at(sink, t - 1.0).satellites) {
    if (before.arc == 0) continue;
    ++arcs.all;
    for (const SatelliteReport& after : report_at(sink, t + 1.0).satellites)
      arcs.continued += after.satellite == before.satellite && after.arc == before.arc ? 1 : 0;
  }
  return arcs;
}

TEST_CASE("a wrong heading costs the attitude alone; a command ends arcs and outages as well") {
  constexpr double kCommand_s = 40.0, kBeforeGap_s = 50.0, kAfterGap_s = 58.0;
  SyntheticDriveOptions options;
  options.duration_s = 70.0;
  options.doppler_sigma_m_s = 0.03;
  options.code_sigma_m = 0.5;
  options.carrier_sigma_m = 0.002;
  SyntheticDrive drive = synthetic_drive(options);
  std::erase_if(drive.epochs, [&](const RawEpoch& raw) {
    return seconds(raw.time) > kBeforeGap_s + 0.5 && seconds(raw.time) < kAfterGap_s - 0.5;
  });
  NavigatorConfig config = drive_navigator_config(options);
  config.ekf.use_carrier = true;
  config.alignment.velocity_matching = config.alignment.heading_watch = true;
  config.alignment.max_reverse_speed_m_s = 5.0;
  config.alignment.lever_arm_b = options.lever_arm_b;
  const SyntheticPath path(options);
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(options.start);
  const double heading = euler_from_rotation(C_ne * path.state(0.0).q_eb.toRotationMatrix()).yaw;
  config.alignment.initial_heading = wrap_to_pi(heading + 1.57);
  for (const bool commands : {false, true}) {
    CAPTURE(commands);
    RecordingSink sink;
    Navigator pipeline(config, &sink);
    feed(drive, &pipeline, [&](const RawEpoch& raw, Sequencer* sequencer) {
      for (const double t : {kCommand_s, kBeforeGap_s})
        if (commands && std::abs(seconds(raw.time) - t) < 0.5)
          sequencer->on_command({CommandKind::kRestart, 0.0, 0.0});
    });
    const auto causes = resets(sink);
    REQUIRE(causes.size() == (commands ? 3u : 1u));
    CHECK(causes[0] == ResetCause::kHeading);
    const auto event = std::find_if(sink.events.begin(), sink.events.end(), [](const Event& e) {
      return e.kind == EventKind::kFilterReset;
    });
    CHECK(report_at(sink, seconds(event->time) - 1.0).solution.has_attitude);
    CHECK_FALSE(report_at(sink, seconds(event->time)).solution.has_attitude);
    const Arcs heading_reset = arcs_over(sink, seconds(event->time));
    CHECK(heading_reset.all >= 8);
    CHECK(heading_reset.continued == heading_reset.all);
    const Arcs command = arcs_over(sink, kCommand_s);
    CHECK(command.all >= 8);
    CHECK(command.continued == (commands ? 0 : command.all));
    CHECK(report_at(sink, kCommand_s).solution.has_attitude == !commands);
    CHECK(sink.count(EventKind::kOutageOver) == (commands ? 0u : 1u));
    CHECK(worst_error(sink, drive, 65.0, 70.0) < 5.0);
  }
}

}  // namespace
}  // namespace leonav::test
