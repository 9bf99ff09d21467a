#include "core/gnss/propagation/antenna_pattern_store.h"

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "antenna_patterns.h"
#include "signals/all_satellites.h"
#include "support/catch.h"

namespace leonav {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::receiver_pattern;
using test::satellite_pattern;

GpsTime week(int number) { return GpsTime::from_week_and_tow(number, 1.0); }

// Range of a satellite straight above, whose offset points to the antenna.
AntennaRange overhead(const AntennaPatternStore& ephemeris_store, SatelliteId id, char band,
                      GpsTime time) {
  Matrix3d C_es;
  C_es << 0, 0, -1, 0, 1, 0, 1, 0, 0;
  return ephemeris_store.satellite_range(id, band, time, Vector3d(2.6e7, 0, 0), C_es,
                                         Vector3d(6.4e6, 0, 0));
}

const Vector3d kZenith(0, 0, -1);

// Three of the satellite's bands.
std::string bands_of(SatelliteId id) {
  if (id.system == System::kGalileo) return "157";
  return id.system == System::kBeidou ? "267" : "125";
}

BandPlan three_leo_bands() {
  BandPlan plan;
  plan.set_leo('5', plan.frequency_hz(System::kGps, '5'));
  return plan;
}

// The pattern number `i` of six: three bands from the beginning, then the same from week 2000 on.
// Its offset is i + 1 mm.
AntennaPattern pattern_of(SatelliteId id, int i) {
  AntennaPattern pattern =
      satellite_pattern(id, bands_of(id)[static_cast<std::size_t>(i % 3)], {0, 0, i + 1.0});
  if (i >= 3) pattern.valid_from = week(2000);
  return pattern;
}

// Whether the store has that pattern.
bool has(const AntennaPatternStore& store, SatelliteId id, int i) {
  const char band = bands_of(id)[static_cast<std::size_t>(i % 3)];
  const AntennaRange range = overhead(store, id, band, week(i >= 3 ? 2100 : 1999));
  return range.status == AntennaStatus::kOk && std::abs(range.range_m + (i + 1) * 1e-3) < 1e-7;
}

}  // namespace

TEST_CASE("A satellite's pattern serves in its validity, the later one where two do",
          "[antenna_catalog]") {
  AntennaPatternStore ephemeris_store;
  const SatelliteId g05{System::kGps, 5};
  AntennaPattern pattern = satellite_pattern(g05, '1', {0, 0, 1000});
  pattern.valid_from = week(1000);
  pattern.valid_until = week(1500);
  REQUIRE(ephemeris_store.add(pattern));
  CHECK(overhead(ephemeris_store, g05, '1', week(999)).status == AntennaStatus::kNone);
  CHECK(overhead(ephemeris_store, g05, '1', week(1500)).status == AntennaStatus::kOk);
  CHECK(overhead(ephemeris_store, g05, '1', week(1501)).status == AntennaStatus::kNone);
  CHECK(overhead(ephemeris_store, g05, '1', week(1501)).range_m == 0.0);
  CHECK(overhead(ephemeris_store, g05, '1', week(1200)).range_m == Approx(-1.0).margin(1e-7));
  CHECK(overhead(ephemeris_store, {System::kGalileo, 5}, '1', week(1200)).status ==
        AntennaStatus::kNone);

  pattern.offset_m.z() = 2.0;
  pattern.valid_from = week(1400);
  pattern.valid_until = GpsTime();
  REQUIRE(ephemeris_store.add(pattern));
  CHECK(overhead(ephemeris_store, g05, '1', week(1399)).range_m == Approx(-1.0).margin(1e-7));
  CHECK(overhead(ephemeris_store, g05, '1', week(1450)).range_m == Approx(-2.0).margin(1e-7));
  CHECK(overhead(ephemeris_store, g05, '1', week(2450)).range_m == Approx(-2.0).margin(1e-7));

  pattern.offset_m.z() = 2.5;  // the same start: a correction of it
  REQUIRE(ephemeris_store.add(pattern));
  CHECK(overhead(ephemeris_store, g05, '1', week(1450)).range_m == Approx(-2.5).margin(1e-7));
  CHECK(overhead(ephemeris_store, g05, '1', week(1200)).range_m == Approx(-1.0).margin(1e-7));

  pattern.offset_m.z() = 3.0;  // a third interval: the first to come goes
  pattern.valid_from = week(2000);
  REQUIRE(ephemeris_store.add(pattern));
  CHECK(overhead(ephemeris_store, g05, '1', week(2100)).range_m == Approx(-3.0).margin(1e-7));
  CHECK(overhead(ephemeris_store, g05, '1', week(1450)).range_m == Approx(-2.5).margin(1e-7));
  CHECK(overhead(ephemeris_store, g05, '1', week(1200)).status == AntennaStatus::kNone);
}

TEST_CASE("A missing band takes its neighbour's pattern and says so", "[antenna_catalog]") {
  AntennaPatternStore ephemeris_store;
  const SatelliteId g05{System::kGps, 5}, l05{System::kLeo, 5}, e05{System::kGalileo, 5};
  REQUIRE(ephemeris_store.add(satellite_pattern(g05, '1', {0, 0, 1000})));
  CHECK(overhead(ephemeris_store, g05, '5', week(2000)).status == AntennaStatus::kNone);
  REQUIRE(ephemeris_store.add(satellite_pattern(g05, '2', {0, 0, 2000})));
  const AntennaRange l5 = overhead(ephemeris_store, g05, '5', week(2000));
  CHECK(l5.status == AntennaStatus::kNeighbourBand);
  CHECK(l5.range_m == Approx(-2.0).margin(1e-7));
  CHECK(overhead(ephemeris_store, g05, '1', week(2000)).status == AntennaStatus::kOk);
  CHECK(overhead(ephemeris_store, g05, '4', week(2000)).status == AntennaStatus::kNone);

  REQUIRE(ephemeris_store.add(satellite_pattern(e05, '7', {0, 0, 700})));
  REQUIRE(ephemeris_store.add(satellite_pattern(e05, '5', {0, 0, 500})));
  CHECK(overhead(ephemeris_store, e05, '8', week(2000)).range_m < -0.4);
  CHECK(overhead(ephemeris_store, e05, '6', week(2000)).range_m == Approx(-0.7).margin(1e-7));
  CHECK(overhead(ephemeris_store, e05, '1', week(2000)).status == AntennaStatus::kNone);

  REQUIRE(ephemeris_store.add(satellite_pattern(l05, '1', {0, 0, 100})));
  CHECK(overhead(ephemeris_store, l05, '1', week(2000)).status == AntennaStatus::kOk);
  CHECK(overhead(ephemeris_store, l05, '2', week(2000)).status == AntennaStatus::kNone);
}

TEST_CASE("A receiver's pattern serves every system by frequency", "[antenna_catalog]") {
  AntennaPatternStore ephemeris_store;
  CHECK(ephemeris_store.receiver_range(System::kGps, '1', kZenith).status == AntennaStatus::kNone);
  REQUIRE(ephemeris_store.add(receiver_pattern(System::kGps, '2', {0, 0, 120})));
  REQUIRE(ephemeris_store.add(receiver_pattern(System::kGps, '1', {0, 0, 90})));
  const auto check = [&](System system, char band, double range_m, AntennaStatus status) {
    const AntennaRange range = ephemeris_store.receiver_range(system, band, kZenith);
    INFO(to_string(system) << band);
    CHECK(range.range_m == Approx(range_m).margin(1e-9));
    CHECK(range.status == status);
  };
  check(System::kGps, '1', -0.090, AntennaStatus::kOk);
  check(System::kGps, '5', -0.120, AntennaStatus::kNeighbourBand);
  check(System::kLeo, '2', -0.120, AntennaStatus::kOk);
  check(System::kGalileo, '1', -0.090, AntennaStatus::kOk);
  check(System::kGalileo, '5', -0.120, AntennaStatus::kNeighbourBand);
  check(System::kBeidou, '2', -0.090, AntennaStatus::kNeighbourBand);
  check(System::kBeidou, '6', -0.120, AntennaStatus::kNeighbourBand);
  REQUIRE(ephemeris_store.add(receiver_pattern(System::kGalileo, '1', {0, 0, 91})));
  check(System::kGalileo, '1', -0.091, AntennaStatus::kOk);
  check(System::kGps, '1', -0.090, AntennaStatus::kOk);
  REQUIRE(ephemeris_store.add(receiver_pattern(System::kGalileo, '1', {0, 0, 92})));
  check(System::kGalileo, '1', -0.092, AntennaStatus::kOk);
}

TEST_CASE("The antenna catalogue refuses what it cannot hold and keeps the rest",
          "[antenna_catalog]") {
  AntennaPatternStore ephemeris_store;
  const SatelliteId c05{System::kBeidou, 5};
  AntennaPattern wide = satellite_pattern(c05, '1', {0, 0, 1});
  wide.variation.angle_step = 0.01;
  wide.variation.angles = static_cast<int>(kMaxNadirValues) + 1;
  wide.variation.azimuths = 1;
  wide.variation.values.resize(kMaxNadirValues + 1);
  REQUIRE(is_sane(wide));
  CHECK_FALSE(ephemeris_store.add(wide));
  AntennaPattern unsound = satellite_pattern(c05, '1', {0, 0, std::nan("")});
  CHECK_FALSE(ephemeris_store.add(unsound));
  CHECK(ephemeris_store.counters().refused == 2);
  CHECK(overhead(ephemeris_store, c05, '1', week(2000)).status == AntennaStatus::kNone);
  // Every satellite there is, with both intervals of two bands: as many as there is room for.
  for (const System system : kSystems) {
    for (std::uint16_t number = 1; number < 400; ++number) {
      if (!is_valid({system, number})) continue;
      for (const char band : {'1', '2'}) {
        AntennaPattern pattern = satellite_pattern({system, number}, band, {0, 0, 1.0 * number});
        if (!is_sane(pattern)) continue;
        CHECK(ephemeris_store.add(pattern));
        pattern.valid_from = week(2000);
        CHECK(ephemeris_store.add(pattern));
      }
    }
  }
  CHECK(overhead(ephemeris_store, {System::kLeo, 399}, '1', week(2100)).range_m == Approx(-0.399));
  CHECK(overhead(ephemeris_store, {System::kGps, 63}, '1', week(1999)).range_m == Approx(-0.063));
  CHECK(overhead(ephemeris_store, {System::kGalileo, 1}, '1', week(1999)).range_m ==
        Approx(-0.001));
}

TEST_CASE("Beyond the antenna catalogue, every satellite keeps the patterns that came last",
          "[antenna_catalog]") {
  AntennaPatternStore store(three_leo_bands());
  const std::vector<SatelliteId> all = test::all_satellites();
  REQUIRE(all.size() == kMaxEphemerisSatellites);
  REQUIRE(kMaxSatelliteAntennas == 4 * all.size());
  for (int i = 0; i < 6; ++i)
    for (const SatelliteId id : all) REQUIRE(store.add(pattern_of(id, i)));
  for (const SatelliteId id : all) {
    CAPTURE(to_string(id.system), id.number);
    for (int i = 0; i < 6; ++i) CHECK(has(store, id, i) == (i >= 2));
  }
  CHECK(store.counters().refused == 0);
}

TEST_CASE("A catalogue larger than the store, sent time and again, leaves the patterns in use",
          "[antenna_catalog]") {
  AntennaPatternStore store(three_leo_bands());
  const std::vector<SatelliteId> all = test::all_satellites();
  const std::array in_use = {all.front(), all[100], all.back()};
  const auto revision = [&](SatelliteId id) {
    return overhead(store, id, bands_of(id)[0], week(1999)).revision;
  };
  for (const SatelliteId id : in_use)
    for (int i = 0; i < 2; ++i) REQUIRE(store.add(pattern_of(id, i)));
  std::vector<std::uint64_t> revisions;
  for (const SatelliteId id : in_use) revisions.push_back(revision(id));
  for (int round = 0; round < 3; ++round) {
    for (int i = 0; i < 6; ++i) {
      for (const SatelliteId id : all) REQUIRE(store.add(pattern_of(id, i)));
      for (std::size_t k = 0; k < in_use.size(); ++k) {
        CAPTURE(round, i, k);
        CHECK(has(store, in_use[k], 0));
        CHECK(has(store, in_use[k], 1));
        CHECK(revision(in_use[k]) == revisions[k]);
      }
    }
  }
}

TEST_CASE("A pattern that was sent again is not the first to go", "[antenna_catalog]") {
  AntennaPatternStore store(three_leo_bands());
  const std::vector<SatelliteId> all = test::all_satellites();
  const SatelliteId most = all.front(), fewest = all.back();
  const auto count = [&](SatelliteId id) { return id == most ? 5 : id == fewest ? 3 : 4; };
  for (const SatelliteId id : all)
    for (int i = 0; i < count(id); ++i) REQUIRE(store.add(pattern_of(id, i)));
  for (int i = 0; i < 5; ++i) REQUIRE(has(store, most, i));
  const auto revision = [&] {
    return overhead(store, most, bands_of(most)[0], week(1999)).revision;
  };
  const std::uint64_t before = revision();
  REQUIRE(store.add(pattern_of(most, 0)));
  CHECK(revision() == before);
  // From here on none of them is in use.
  REQUIRE(overhead(store, fewest, bands_of(fewest)[0], week(1998)).revision != 0);
  REQUIRE(store.add(pattern_of(fewest, 3)));  // the first for which there is no room
  for (int i = 0; i < 5; ++i) CHECK(has(store, most, i) == (i != 1));
  for (int i = 0; i < 4; ++i) CHECK(has(store, fewest, i));
}

TEST_CASE("a pattern's revision changes with it, and not where the same one is sent again") {
  AntennaPatternStore ephemeris_store;
  const SatelliteId g07{System::kGps, 7};
  CHECK(overhead(ephemeris_store, g07, '1', week(2100)).revision == 0);
  AntennaPattern pattern = satellite_pattern(g07, '1', {0, 0, 1000});
  REQUIRE(ephemeris_store.add(pattern));
  const std::uint64_t first = overhead(ephemeris_store, g07, '1', week(2100)).revision;
  CHECK(first != 0);
  REQUIRE(ephemeris_store.add(pattern));
  CHECK(overhead(ephemeris_store, g07, '1', week(2100)).revision == first);
  pattern.offset_m.z() = 1.1;
  REQUIRE(ephemeris_store.add(pattern));
  CHECK(overhead(ephemeris_store, g07, '1', week(2100)).revision != first);
  CHECK(ephemeris_store.counters().added == 3);

  const Eigen::Vector3d up(0, 0, -1);
  AntennaPattern own = receiver_pattern(System::kGps, '1', {0, 0, 90}, {1, 2, 3});
  REQUIRE(ephemeris_store.add(own));
  const std::uint64_t mine = ephemeris_store.receiver_range(System::kGps, '1', up).revision;
  REQUIRE(ephemeris_store.add(own));
  CHECK(ephemeris_store.receiver_range(System::kGps, '1', up).revision == mine);
  own.variation.values[1] = 0.0f;
  REQUIRE(ephemeris_store.add(own));
  CHECK(ephemeris_store.receiver_range(System::kGps, '1', up).revision != mine);
}

}  // namespace leonav
