// What damaged observations cost: themselves.
#include <limits>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

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

TEST_CASE("Dopplers that are all wrong do not overthrow what codes and motion agree on") {
  for (const MotionModel motion : {MotionModel::kInertial, MotionModel::kConstantVelocity}) {
    for (const double factor : {-1.0, 0.0, 0.5}) {  // another sign, none measured, another unit
      CAPTURE(static_cast<int>(motion), factor);
      SyntheticDrive drive = drive_of(60.0);
      const NavigatorConfig config = drive_navigator_config(drive.options, motion);
      damage(&drive, 30.0, 50.5, [&](SignalObservation* o) { o->doppler_hz *= factor; });
      const RecordingSink sink = run(drive, config);
      CHECK(resets(sink).empty());
      CHECK(worst_error(sink, drive, 29.0, 60.0) < 10.0);
    }
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

TEST_CASE("noise far above what is configured is reported, though nothing stands out") {
  SyntheticDriveOptions options;
  options.duration_s = 120.0;
  options.imu_rate_hz = 1.0;
  for (const double scale : {1.0, 3.0}) {
    CAPTURE(scale);
    options.code_sigma_m = scale * 1.0;  // the default sigmas
    options.doppler_sigma_m_s = scale * 0.1;
    const SyntheticDrive drive = synthetic_drive(options);
    const RecordingSink sink =
        run(drive, drive_navigator_config(options, MotionModel::kConstantVelocity));
    CHECK(resets(sink).empty());
    CHECK((sink.count(EventKind::kImprobable) > 0) == (scale > 2.0));
  }
}

TEST_CASE("a position that all codes contradict is widened, told and counted") {
  SyntheticDrive drive = drive_of(60.0);
  const SyntheticDrive elsewhere = drive_of(60.0, 300.0);
  const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  CHECK(run(drive, config).count(EventKind::kPredictionWidened) == 0);
  for (std::size_t i = 0; i < drive.epochs.size(); ++i)
    if (seconds(drive.epochs[i].time) >= 40.0) drive.epochs[i] = elsewhere.epochs[i];
  const RecordingSink sink = run(drive, config);
  std::size_t counted = 0, told = 0;
  for (const EpochReport& report : sink.epochs)
    counted += static_cast<std::size_t>(report.widened_predictions);
  for (const Event& event : sink.events) {
    if (event.kind != EventKind::kPredictionWidened || event.code != 0) continue;
    if (told++ == 0) CHECK(event.value > 100.0);  // 300 m over three axes
    CHECK(seconds(event.time) >= 40.0);
  }
  CHECK(told >= 1);
  CHECK(counted == sink.count(EventKind::kPredictionWidened));  // so few are not thinned
}

}  // namespace
}  // namespace leonav::test
