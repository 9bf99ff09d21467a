// A filter that is wrong, or is told so, by satellites too few to tell which.
#include "core/navigator/lock_out_watch.h"
#include "stage_drive.h"
#include "support/catch.h"

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

EkfUpdateResult result_of(int codes, int codes_rejected, int dopplers, int dopplers_rejected,
                          double largest_m = 20.0) {
  EkfUpdateResult result;
  const auto code = static_cast<std::size_t>(Observable::kCode);
  const auto doppler = static_cast<std::size_t>(Observable::kDoppler);
  result.offered[code] = codes;
  result.rejected[code] = codes_rejected;
  result.largest_rejected[code] = largest_m;
  result.offered[doppler] = dopplers;
  result.rejected[doppler] = dopplers_rejected;
  return result;
}

// Epochs of 1 s until it is noticed; 0: not within ten minutes.
int noticed_after(const EkfUpdateResult& result) {
  LockOutWatch watch;
  for (int k = 0; k < 600; ++k)
    if (watch.add(result, kSkyEpoch.plus_seconds(k))) return k;
  return 0;
}

}  // namespace

TEST_CASE("half a minute against codes and Dopplers is a lock-out, against codes alone none") {
  CHECK(noticed_after(result_of(3, 3, 3, 3)) == 30);
  CHECK(noticed_after(result_of(3, 2, 3, 2)) == 30);
  CHECK(noticed_after(result_of(3, 3, 3, 0)) == 0);
  CHECK(noticed_after(result_of(3, 3, 0, 0)) == 0);          // no Doppler measured
  CHECK(noticed_after(result_of(3, 3, 3, 0, 150.0)) == 30);  // no house is that far
  CHECK(noticed_after(result_of(3, 1, 3, 3)) == 0);
  CHECK(noticed_after(result_of(1, 1, 1, 1)) == 0);  // it may be the one
}

TEST_CASE("epochs that agree with the filter count against a lock-out") {
  LockOutWatch watch;
  const EkfUpdateResult against = result_of(3, 3, 3, 3), agrees = result_of(3, 0, 3, 0);
  int noticed = 0;
  for (int k = 0; k < 200; ++k)
    noticed += watch.add(k % 2 == 0 ? against : agrees, kSkyEpoch.plus_seconds(k)) ? 1 : 0;
  CHECK(noticed == 0);
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
  const SyntheticDrive there = drive_of(300.0, 220.0);
  SyntheticDrive drive = carried_away(300.0, 60.0, 220.0);
  const NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kInertial);
  leave(3, 59.5, config, &drive);
  const RecordingSink sink = run(drive, config);
  CHECK(resets(sink) == std::vector<ResetCause>{ResetCause::kLockedOut});
  // Three ranges to satellites do not tell all of a position: its sigma holds what they leave.
  int held = 0, count = 0;
  for (const EpochReport& report : sink.epochs) {
    if (seconds(report.time) < 95.0) continue;
    CHECK(report.solution.has_attitude);
    ++count;
    if (epoch_error(report, there) < 3.0 * report.solution.sigma_p_n.norm()) ++held;
  }
  CHECK(count > 200);
  CHECK(held == count);
}

}  // namespace leonav::test
