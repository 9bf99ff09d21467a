// The stage's judgement: what damaged observations cost, and when the filter is started anew.
#include "core/navigator/gnss_stage.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/navigator/pipeline.h"
#include "recording_sink.h"
#include "support/catch.h"
#include "support/navigator_config.h"
#include "support/synthetic_drive.h"

namespace leonav::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
// A filter that never widens its covariance must be restarted where its prediction is wrong.
constexpr double kNeverWiden = 1e9;

SyntheticDrive drive_of(double duration_s, double east_m = 0.0, bool imu = true) {
  SyntheticDriveOptions options;
  options.duration_s = duration_s;
  options.start.longitude += east_m / (6.378e6 * std::cos(options.start.latitude));
  if (!imu) options.imu_rate_hz = 1.0;  // few samples: nobody reads them
  return synthetic_drive(options);
}

double seconds(GpsTime time) { return seconds_between(time, kSkyEpoch); }

RecordingSink run(const SyntheticDrive& drive, const NavigatorConfig& config) {
  RecordingSink sink;
  Pipeline pipeline(config, &sink);
  Sequencer& sequencer = pipeline.sequencer();
  if (config.motion == MotionModel::kInertial) {
    feed(
        drive, 0.06, [&](const Ephemeris& e) { sequencer.on_ephemeris(e); },
        [&](const ImuSample& s) { sequencer.on_imu(s); },
        [&](const RawEpoch& r) { sequencer.on_raw_epoch(r); });
  } else {
    for (const Ephemeris& e : drive.ephemerides) sequencer.on_ephemeris(e);
    for (const RawEpoch& r : drive.epochs) sequencer.on_raw_epoch(r);
  }
  return sink;
}

// Error of the epochs' own solutions against the truth, in metres.
double epoch_error(const EpochReport& report, const SyntheticDrive& drive) {
  const SyntheticPath path(drive.options);
  const double t = seconds(report.time);
  const Eigen::Vector3d truth =
      report.solution.has_attitude ? path.state(t).p_e : path.antenna_p_e(t);
  return (report.solution.p_e - truth).norm();
}
double worst_error(const RecordingSink& sink, const SyntheticDrive& drive, double from_s,
                   double to_s) {
  double worst = 0.0;
  int count = 0;
  for (const EpochReport& report : sink.epochs) {
    if (seconds(report.time) < from_s || seconds(report.time) > to_s) continue;
    ++count;
    worst = std::max(worst, epoch_error(report, drive));
  }
  return count > 0 ? worst : 1e9;
}

// The highest GPS satellite of the whole drive: losing it is felt.
SatelliteId victim_of(const RecordingSink& clean) {
  const auto& satellites = clean.epochs[clean.epochs.size() / 2].satellites;
  return std::max_element(satellites.begin(), satellites.end(),
                          [](const auto& a, const auto& b) { return a.elevation < b.elevation; })
      ->satellite;
}

template <typename Change>
void damage(SyntheticDrive* drive, double from_s, double to_s, Change change) {
  for (RawEpoch& raw : drive->epochs) {
    if (seconds(raw.time) < from_s || seconds(raw.time) > to_s) continue;
    for (SignalObservation& o : raw.observations) change(&o);
  }
}

Reason reason_of(const EpochReport& report, SatelliteId id) {
  for (const SatelliteReport& s : report.satellites) {
    if (s.satellite == id) return s.reason;
  }
  FAIL("satellite " << to_string(id) << " is missing from the report");
  return Reason::kUsed;
}

std::vector<ResetCause> resets(const RecordingSink& sink) {
  std::vector<ResetCause> causes;
  for (const Event& event : sink.events) {
    if (event.kind == EventKind::kFilterReset && event.stage == Stage::kGnss) {
      causes.push_back(static_cast<ResetCause>(event.code));
    }
  }
  return causes;
}

// The drive is that of `first` until `change_s`, then as if the vehicle had been carried away.
SyntheticDrive carried_away(double duration_s, double change_s, double east_m) {
  SyntheticDrive drive = drive_of(duration_s);
  const SyntheticDrive there = drive_of(duration_s, east_m);
  for (std::size_t k = 0; k < drive.epochs.size(); ++k) {
    if (seconds(drive.epochs[k].time) >= change_s) drive.epochs[k] = there.epochs[k];
  }
  return drive;
}

TEST_CASE("a satellite off by 100 km in mid-run is named an outlier and costs nothing else") {
  for (const MotionModel motion : {MotionModel::kInertial, MotionModel::kConstantVelocity}) {
    for (const double error_m : {1e5, -1e5, 300.0}) {
      CAPTURE(static_cast<int>(motion), error_m);
      SyntheticDrive drive = drive_of(60.0);
      const NavigatorConfig config = drive_navigator_config(drive.options, motion);
      const RecordingSink clean = run(drive, config);
      const SatelliteId victim = victim_of(clean);
      damage(&drive, 30.0, 40.5, [&](SignalObservation* o) {
        if (o->satellite == victim) o->pseudorange_m += error_m;
      });
      const RecordingSink sink = run(drive, config);
      REQUIRE(sink.epochs.size() == clean.epochs.size());
      int damaged = 0;
      for (std::size_t k = 0; k < sink.epochs.size(); ++k) {
        const double t = seconds(sink.epochs[k].time);
        if (t < 30.0 || t > 40.5) continue;
        ++damaged;
        for (const AidingReport& aiding : sink.epochs[k].aiding) {
          if (aiding.satellite != victim || aiding.observable != Observable::kCode) continue;
          CHECK(aiding.reason == Reason::kOutlier);
          CHECK(aiding.weight_factor == 0.0);
        }
        CHECK(sink.epochs[k].satellites_used + 1 >= clean.epochs[k].satellites_used);
      }
      CHECK(damaged == 11);
      CHECK(resets(sink).empty());
      CHECK(worst_error(sink, drive, 30.0, 60.0) < worst_error(clean, drive, 30.0, 60.0) + 0.2);
    }
  }
}

TEST_CASE("observations that are no numbers cost themselves; an epoch of nothing else, itself") {
  for (const double bad : {kNan, std::numeric_limits<double>::infinity(), -1.0, 0.0, 1e300}) {
    CAPTURE(bad);
    SyntheticDrive drive = drive_of(60.0);
    const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
    const RecordingSink clean = run(drive, config);
    const SatelliteId victim = victim_of(clean);
    damage(&drive, 30.0, 40.5, [&](SignalObservation* o) {
      if (o->satellite == victim) o->pseudorange_m = o->doppler_hz = o->cn0_dbhz = bad;
    });
    damage(&drive, 45.0, 46.5, [&](SignalObservation* o) { o->pseudorange_m = bad; });
    const RecordingSink sink = run(drive, config);
    REQUIRE(sink.epochs.size() == clean.epochs.size());
    for (const EpochReport& report : sink.epochs) {
      CHECK(report.solution.p_e.allFinite());
      CHECK(report.solution.sigma_p_n.allFinite());
      const double t = seconds(report.time);
      if (t < 30.0 || t > 40.5) continue;
      const Reason reason = reason_of(report, victim);
      CHECK((reason == Reason::kImplausible || reason == Reason::kNoUsableSignal));
      CHECK(report.satellites_used >= 10);
    }
    CHECK(resets(sink).empty());
    CHECK(worst_error(sink, drive, 30.0, 60.0) < worst_error(clean, drive, 30.0, 60.0) + 0.2);
  }
}

TEST_CASE("a start with a satellite off by 100 km excludes it, robust weighting or not") {
  for (const bool robust : {true, false}) {
    CAPTURE(robust);
    SyntheticDrive drive = drive_of(20.0, 0.0, false);
    NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kConstantVelocity);
    config.ekf.robust.enabled = robust;
    const SatelliteId victim = victim_of(run(drive, config));
    damage(&drive, 0.0, 1.5, [&](SignalObservation* o) {
      if (o->satellite == victim) o->pseudorange_m += 1e5;
    });
    const RecordingSink sink = run(drive, config);
    REQUIRE(sink.solutions.size() == drive.epochs.size());
    int codes = 0;  // its Doppler is good, and counts
    for (const AidingReport& aiding : sink.epochs.front().aiding) {
      if (aiding.satellite != victim || aiding.observable != Observable::kCode) continue;
      ++codes;
      CHECK(aiding.reason == Reason::kOutlier);
    }
    CHECK(codes == 1);
    CHECK(worst_error(sink, drive, 0.0, 20.0) < 3.0);
  }
}

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
      o.doppler_hz -= 50.0 / wavelength_m(o.satellite.system, o.code.band);
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

TEST_CASE("a point solution that nothing checks does not overthrow the filter") {
  SyntheticDrive drive = carried_away(90.0, 60.0, 3'000.0);
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

TEST_CASE("numbers that overflow never reach the navigator, and the filter comes back") {
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
    if (hostile) work->block.back().delta_velocity_b.setConstant(1e300);
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
  CHECK(broken <= 1);
  CHECK(valid >= 50);
  REQUIRE(resets(sink).size() == 1);
  CHECK(resets(sink)[0] == ResetCause::kNotFinite);
  CHECK(stage.ekf().has_attitude());
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

TEST_CASE("a restart in mid-drive aligns again and is where it was; a heading spares the wait") {
  const SyntheticDrive drive = drive_of(90.0);
  const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  for (const bool heading_given : {false, true}) {
    CAPTURE(heading_given);
    RecordingSink sink;
    Pipeline pipeline(config, &sink);
    Sequencer& sequencer = pipeline.sequencer();
    const SyntheticPath path(drive.options);
    const auto on_epoch = [&](const RawEpoch& raw) {
      const double t = seconds(raw.time);
      if (std::abs(t - 50.0) < 0.5) {
        sequencer.on_command({CommandKind::kRestart, 0.0, 0.0});
        if (heading_given) {
          const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(drive.options.start);
          const Eigen::Matrix3d C_eb = path.state(t).q_eb.toRotationMatrix();
          sequencer.on_command(
              {CommandKind::kSetHeading, euler_from_rotation(C_ne * C_eb).yaw, 0.05});
        }
      }
      sequencer.on_raw_epoch(raw);
    };
    feed(
        drive, 0.06, [&](const Ephemeris& e) { sequencer.on_ephemeris(e); },
        [&](const ImuSample& s) { sequencer.on_imu(s); }, on_epoch);
    CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kCommand});
    CHECK(sink.count(EventKind::kAligned) == 2);
    CHECK(sink.epochs.size() == 89);
    CHECK(sink.epochs.back().solution.has_attitude);
    CHECK(worst_error(sink, drive, 75.0, 90.0) < 1.0);
  }
}

}  // namespace
}  // namespace leonav::test
