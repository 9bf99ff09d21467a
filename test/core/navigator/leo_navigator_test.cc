// GPS by broadcast ephemerides and LEO satellites by precise states alone, through the pipeline.
#include <algorithm>

#include "core/navigator/navigator.h"
#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

bool is_leo(SatelliteId id) { return id.system == System::kLeo; }

TEST_CASE("LEO satellites known by precise states alone take part in the whole pipeline") {
  SyntheticDriveOptions options;
  options.duration_s = 90.0;
  options.galileo = false;
  options.leo = true;
  SyntheticDrive drive = synthetic_drive(options);
  std::vector<Ephemeris> leo;
  std::copy_if(drive.ephemerides.begin(), drive.ephemerides.end(), std::back_inserter(leo),
               [](const Ephemeris& e) { return is_leo(e.satellite); });
  std::erase_if(drive.ephemerides, [](const Ephemeris& e) { return is_leo(e.satellite); });
  REQUIRE(leo.size() == 182);

  RecordingSink sink;
  Navigator pipeline(drive_navigator_config(options), &sink);
  Sequencer& sequencer = pipeline.sequencer();
  ProductNodes product(leo, 30.0, 180.0);
  feed(
      drive, 0.06, [&](const Ephemeris& e) { sequencer.on_ephemeris(e); },
      [&](const ImuSample& s) {
        product.send_until(seconds(s.time), &sequencer);
        sequencer.on_imu(s);
      },
      [&](const RawEpoch& r) { sequencer.on_raw_epoch(r); });

  REQUIRE(sink.epochs.size() == 89);
  double worst_m = 0.0;
  int fewest_leo = 1000, beyond_letter_l = 0;
  for (const EpochReport& report : sink.epochs) {
    if (seconds_between(report.time, kSkyEpoch) < 40.0) continue;
    const NavState truth = drive.truth_at(report.time);
    worst_m = std::max(worst_m, (report.solution.p_e - truth.p_e).norm());
    int used = 0;
    for (const SatelliteReport& satellite : report.satellites) {
      if (!is_leo(satellite.satellite) || satellite.reason == Reason::kLowElevation) continue;
      CHECK(satellite.reason == Reason::kUsed);
      CHECK(satellite.source == OrbitSource::kPrecise);
      ++used;
      beyond_letter_l += satellite.satellite.number >= 100 ? 1 : 0;  // M00 and on
    }
    fewest_leo = std::min(fewest_leo, used);
    CHECK(std::isfinite(report.clock_m[index_of(System::kLeo)]));
  }
  CAPTURE(worst_m, fewest_leo, beyond_letter_l);
  CHECK(worst_m < 0.05);
  CHECK(fewest_leo >= 3);
  CHECK(beyond_letter_l > 0);
  CHECK(sink.epochs.back().solution.source == Source::kEkf);
}

}  // namespace
}  // namespace leonav::test
