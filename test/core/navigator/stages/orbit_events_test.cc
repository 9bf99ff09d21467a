// What is told of satellites whose orbits change between precise and broadcast ones.
#include <algorithm>
#include <iterator>
#include <map>
#include <vector>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

// Precise states of GPS every 10 s that come half an interval after they are needed: each serves
// for five seconds, and broadcast elements for the next five.
RecordingSink run_with_late_product(const SyntheticDrive& drive) {
  RecordingSink sink;
  Navigator pipeline(drive_navigator_config(drive.options, MotionModel::kConstantVelocity), &sink);
  Sequencer& sequencer = pipeline.sequencer();
  for (const Ephemeris& e : drive.ephemerides) sequencer.on_ephemeris(e);
  std::vector<Ephemeris> gps;
  std::copy_if(drive.ephemerides.begin(), drive.ephemerides.end(), std::back_inserter(gps),
               [](const Ephemeris& e) { return e.satellite.system == System::kGps; });
  ProductNodes product(gps, 10.0, 5.0);
  for (const RawEpoch& raw : drive.epochs) {
    product.send_until(seconds(raw.time), &sequencer);
    sequencer.on_raw_epoch(raw);
  }
  return sink;
}

struct Switch {
  GpsTime time;
  SatelliteId satellite;
};

// Those of the epochs' own reports.
std::vector<Switch> switches(const RecordingSink& sink, OrbitSource to) {
  std::vector<Switch> found;
  std::map<SatelliteId, OrbitSource> last;
  for (const EpochReport& report : sink.epochs) {
    for (const SatelliteReport& satellite : report.satellites) {
      if (satellite.source == OrbitSource::kNone) continue;
      const auto [place, first] = last.insert({satellite.satellite, satellite.source});
      if (!first && place->second != satellite.source && satellite.source == to)
        found.push_back({report.time, satellite.satellite});
      place->second = satellite.source;
    }
  }
  return found;
}

}  // namespace

TEST_CASE("a satellite's way to broadcast orbits and back is told, the first sixteen times each") {
  const RecordingSink sink = run_with_late_product(drive_of(60.0, 0.0, false));
  for (const bool fallback : {true, false}) {
    CAPTURE(fallback);
    const auto expected =
        switches(sink, fallback ? OrbitSource::kBroadcast : OrbitSource::kPrecise);
    REQUIRE(expected.size() > 30);
    REQUIRE(expected.size() < 256);
    std::size_t told = 0;
    for (const Event& event : sink.events) {
      if (event.kind != (fallback ? EventKind::kOrbitFallback : EventKind::kOrbitReturn)) continue;
      REQUIRE(told < 16);
      CHECK(event.time == expected[told].time);
      CHECK(event.code == static_cast<std::uint8_t>(expected[told].satellite.system));
      CHECK(event.value == expected[told].satellite.number);
      ++told;
    }
    CHECK(told == 16);
  }
  CHECK(to_string(EventKind::kOrbitReturn) == "orbit_return");
}

// The drive with precise states of GPS, which are 15 m off for the satellite `wrong`.
RecordingSink run_with_wrong_orbit(const SyntheticDrive& drive, const NavigatorConfig& config,
                                   SatelliteId wrong) {
  RecordingSink sink;
  Navigator pipeline(config, &sink);
  Sequencer& sequencer = pipeline.sequencer();
  for (const Ephemeris& e : drive.ephemerides) sequencer.on_ephemeris(e);
  for (int s = -300; s <= 360; s += 30) {
    PreciseStates nodes;
    for (const Ephemeris& e : drive.ephemerides) {
      if (e.satellite.system != System::kGps) continue;
      nodes.push_back(product_node(e, kSkyEpoch.plus_seconds(s)));
      if (e.satellite == wrong) nodes.back().p_e += 15.0 * nodes.back().p_e.unitOrthogonal();
    }
    sequencer.on_precise_states(nodes);
  }
  for (const RawEpoch& raw : drive.epochs) sequencer.on_raw_epoch(raw);
  return sink;
}

SatelliteId first_gps_of(const SyntheticDrive& drive) {
  const auto& seen_first = drive.epochs.front().observations;
  const auto wrong = std::find_if(seen_first.begin(), seen_first.end(), [](auto& observation) {
    return observation.satellite.system == System::kGps;
  });
  REQUIRE(wrong != seen_first.end());
  return wrong->satellite;
}

TEST_CASE("a precise orbit 15 m off gives one event, and the satellite's broadcast orbit is used") {
  const SyntheticDrive drive = drive_of(20.0, 0.0, false);
  const SatelliteId wrong = first_gps_of(drive);
  const RecordingSink sink = run_with_wrong_orbit(
      drive, drive_navigator_config(drive.options, MotionModel::kConstantVelocity), wrong);
  int seen = 0, precise = 0;
  for (const EpochReport& report : sink.epochs) {
    for (const SatelliteReport& satellite : report.satellites) {
      if (satellite.satellite == wrong) {
        ++seen;
        CHECK(satellite.source == OrbitSource::kBroadcast);
        CHECK(report.orbits_refused == 1);
      } else if (satellite.source == OrbitSource::kPrecise) {
        ++precise;
      }
    }
  }
  REQUIRE(seen > 5);
  CHECK(precise > 2 * seen);
  int told = 0;
  for (const Event& event : sink.events) {
    if (event.kind != EventKind::kOrbitRefused) continue;
    ++told;
    CHECK(event.code == static_cast<std::uint8_t>(System::kGps));
    CHECK(event.value == wrong.number);
  }
  CHECK(told == 1);
}

TEST_CASE("wrong orbits of a system that is not used are nobody's trouble") {
  const SyntheticDrive drive = drive_of(20.0, 0.0, false);
  NavigatorConfig config = drive_navigator_config(drive.options, MotionModel::kConstantVelocity);
  config.gnss.systems[index_of(System::kGps)].enabled = false;
  const RecordingSink sink = run_with_wrong_orbit(drive, config, first_gps_of(drive));
  REQUIRE(sink.epochs.size() > 5);
  for (const EpochReport& report : sink.epochs) CHECK(report.orbits_refused == 0);
  CHECK(sink.count(EventKind::kOrbitRefused) == 0);
}

}  // namespace leonav::test
