// A filter that is wrong, or is told so, by satellites too few to tell which.
#include "core/navigator/monitors/measurement_rejection_monitor.h"

#include <utility>
#include <vector>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

// GPS satellites that are used from the start of `drive` to its end.
std::vector<SatelliteId> always_used(const SyntheticDrive& drive, const NavigatorConfig& config) {
  const RecordingSink sink = run(drive, config);
  std::vector<SatelliteId> always;
  const auto used = [](const EpochReport& report, SatelliteId id) {
    return std::any_of(report.satellites.begin(), report.satellites.end(), [&](const auto& s) {
      return s.satellite == id && s.reason == Reason::kUsed;
    });
  };
  for (const SatelliteReport& satellite : sink.epochs.back().satellites)
    if (satellite.satellite.system == System::kGps &&
        used(sink.epochs.back(), satellite.satellite) &&
        used(sink.epochs[sink.epochs.size() / 4], satellite.satellite))
      always.push_back(satellite.satellite);
  return always;
}

// Leaves the first `count` of them, from `from_s` on.
void leave(int count, double from_s, const NavigatorConfig& config, SyntheticDrive* drive) {
  std::vector<SatelliteId> left = always_used(*drive, config);
  REQUIRE(static_cast<int>(left.size()) >= count);
  left.resize(static_cast<std::size_t>(count));
  for (RawEpoch& raw : drive->epochs) {
    if (seconds(raw.time) < from_s) continue;
    const auto surplus = [&](const SignalObservation& o) {
      return std::find(left.begin(), left.end(), o.satellite) == left.end();
    };
    auto& all = raw.observations;
    all.erase(std::remove_if(all.begin(), all.end(), surplus), all.end());
  }
}

// An epoch of GPS and what the filter made of it.
struct Judged {
  EkfUpdateResult result;
  MeasurementEpoch epoch;

  Judged& add(Observable observable, std::vector<double> innovations, bool rejected,
              double variance = 1.0) {
    if (epoch.satellites.empty()) {
      epoch.satellites.emplace_back();
      epoch.satellites[0].satellite = {System::kGps, 1};
    }
    for (const double innovation : innovations) {
      Measurement measurement;
      measurement.observable = observable;
      epoch.measurements.push_back(measurement);
      InnovationReport report;
      report.innovation = innovation;
      report.innovation_variance = variance;
      report.weight_factor = rejected ? 0.0 : 1.0;
      result.innovations.push_back(report);
    }
    return *this;
  }
  Judged& codes(std::vector<double> innovations, bool rejected = true) {
    return add(Observable::kCode, std::move(innovations), rejected);
  }
  Judged& dopplers(bool rejected) { return add(Observable::kDoppler, {3.0, -1.0, 2.0}, rejected); }
  Judged& carriers(bool rejected, double variance = 1.0) {
    return add(Observable::kCarrier, {0.1, -2.0, 2.0}, rejected, variance);
  }
};

struct Found {
  RejectionVerdict lock_out = RejectionVerdict::kNone;
  int after = 0;  // epochs of 1 s; 0: nothing in ten minutes
  bool operator==(const Found&) const = default;
};

Found found(const Judged& judged) {
  MeasurementRejectionMonitor watch;
  for (int k = 0; k < 600; ++k) {
    const RejectionVerdict lock_out =
        watch.add(judged.result, judged.epoch, kSkyEpoch.plus_seconds(k));
    if (lock_out != RejectionVerdict::kNone) return {lock_out, k};
  }
  return {};
}

const Found kNothing{}, kPosition{RejectionVerdict::kPosition, 30},
    kClocks{RejectionVerdict::kClocks, 30};

}  // namespace

TEST_CASE("half a minute against codes and Dopplers is a lock-out, against codes alone none") {
  const std::vector<double> off = {10.0, -20.0, 45.0};
  CHECK(found(Judged().codes(off).dopplers(true)) == kPosition);
  CHECK(found(Judged().codes(off).dopplers(false)) == kNothing);
  CHECK(found(Judged().codes(off, false).dopplers(true)) == kNothing);
  CHECK(found(Judged().codes({30.0}).dopplers(true)) == kNothing);  // it may be the one
  CHECK(found(Judged().codes(off)) == kNothing);
  CHECK(found(Judged().codes({10.0, -120.0, 150.0})) == kPosition);
}

TEST_CASE("carriers of arcs from before speak for the filter, new ones for nobody") {
  const std::vector<double> off = {10.0, -120.0, 145.0};
  CHECK(found(Judged().codes(off).dopplers(true).carriers(false)) == kNothing);
  CHECK(found(Judged().codes(off).dopplers(true).carriers(true)) == kPosition);
  CHECK(found(Judged().codes(off).dopplers(true).carriers(false, 2e4)) == kPosition);
  // No way round is that long.
  CHECK(found(Judged().codes({10.0, -500.0, 600.0}).dopplers(false).carriers(false)) == kPosition);
  // One satellite may be that wrong.
  CHECK(found(Judged().codes({0.0, 30.0, 400.0}).dopplers(false).carriers(false)) == kNothing);
}

TEST_CASE("what all codes are off by is the clocks', and who can be checked is not locked out") {
  CHECK(found(Judged().codes({300.0, 302.0, 299.0}).dopplers(false)) == kClocks);
  CHECK(found(Judged().codes({3.0, -52.0, 129.0, 80.0, -60.0}).dopplers(true)) == kPosition);
  CHECK(found(Judged().codes({3.0, -52.0, 129.0, 80.0, -60.0, 9.0}).dopplers(true)) == kNothing);
}

TEST_CASE("epochs that agree with the filter count against a lock-out") {
  MeasurementRejectionMonitor watch;
  const Judged against = Judged().codes({9.0, -8.0, 30.0}).dopplers(true);
  const Judged agrees = Judged().codes({0.1, -0.1, 0.2}, false).dopplers(false);
  for (int k = 0; k < 200; ++k) {
    const Judged& judged = k % 2 == 0 ? against : agrees;
    CHECK(watch.add(judged.result, judged.epoch, kSkyEpoch.plus_seconds(k)) ==
          RejectionVerdict::kNone);
  }
}

TEST_CASE("a filter far from where five satellites say it is starts anew after half a minute") {
  const SyntheticDrive there = drive_of(300.0, 3'000.0);
  SyntheticDrive drive = carried_away(300.0, 60.0, 3'000.0);
  const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  leave(5, 59.5, config, &drive);
  const RecordingSink sink = run(drive, config);
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kLockedOut});
  CHECK(worst_error(sink, there, 60.0, 85.0) > 2'500.0);
  CHECK(worst_error(sink, there, 150.0, 300.0) < 10.0);
}

TEST_CASE("a filter that three satellites contradict goes on from where it is, as unsure") {
  const SyntheticDrive there = drive_of(300.0, 5'000.0);
  SyntheticDrive drive = carried_away(300.0, 60.0, 5'000.0);
  const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  leave(3, 59.5, config, &drive);
  const RecordingSink sink = run(drive, config);
  REQUIRE_FALSE(resets(sink).empty());
  CHECK(resets(sink)[0] == ResetCause::kLockedOut);
  for (const EpochReport& report : sink.epochs)
    if (seconds(report.time) > 91.0 && seconds(report.time) < 115.0)
      CHECK(report.solution.sigma_p_n.norm() > 100.0);
}

TEST_CASE("a filter that is right is not moved by three or four satellites with wrong codes") {
  for (const int satellites : {3, 4}) {
    SyntheticDrive drive = drive_of(240.0);
    const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
    leave(satellites, 59.5, config, &drive);
    for (RawEpoch& raw : drive.epochs) {
      if (seconds(raw.time) < 70.0 || seconds(raw.time) > 150.0) continue;
      for (SignalObservation& o : raw.observations)
        o.pseudorange_m += 20.0 + 37.0 * (o.satellite.number % 4);
    }
    const RecordingSink sink = run(drive, config);
    CHECK(resets(sink).empty());
    CHECK(worst_error(sink, drive, 60.0, 150.0) < 10.0);
  }
}

TEST_CASE(
    "a clock that steps while three satellites are in view costs neither place nor attitude") {
  SyntheticDrive drive = drive_of(240.0);
  const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  leave(3, 59.5, config, &drive);
  for (RawEpoch& raw : drive.epochs)
    for (SignalObservation& o : raw.observations)
      if (seconds(raw.time) > 90.0) o.pseudorange_m += 3'000.0;
  const RecordingSink sink = run(drive, config);
  CHECK(resets(sink).empty());
  CHECK(sink.count(EventKind::kClockStep) >= 1);
  CHECK(worst_error(sink, drive, 60.0, 240.0) < 10.0);
}

}  // namespace leonav::test
