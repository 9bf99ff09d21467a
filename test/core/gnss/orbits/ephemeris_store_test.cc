#include "core/gnss/orbits/ephemeris_store.h"

#include <array>
#include <limits>
#include <vector>

#include "broadcast_oracle.h"
#include "core/base/capacity.h"
#include "gps_5_at_noon.h"
#include "signals/all_satellites.h"
#include "support/catch.h"

namespace leonav {
namespace {

using test::kG05;
using test::kNoon;

Ephemeris gps(int number, double toe_s, std::uint16_t issue) {
  Ephemeris e;
  e.satellite = {System::kGps, static_cast<std::uint16_t>(number)};
  e.toe = e.toc = kNoon.plus_seconds(toe_s);
  e.transmission_time = e.toe.plus_seconds(-7200.0);
  e.issue = issue;
  e.sqrt_a = 5153.7;
  e.i0 = 0.96;
  e.accuracy_m = 2.0;
  return e;
}

Ephemeris galileo(NavigationMessage message, double toe_s) {
  Ephemeris e = gps(11, toe_s, 1);
  e.satellite.system = System::kGalileo;
  e.message = message;
  e.sqrt_a = 5440.6;
  e.transmission_time = e.toe.plus_seconds(600.0);
  return e;
}

// Issue of the elements that serve `id` at noon plus `seconds`; -1: none.
int issue_at(const EphemerisStore& ephemeris_store, SatelliteId id, double seconds) {
  SatelliteState state;
  const Ephemeris* used = nullptr;
  if (ephemeris_store.state_at(id, kNoon.plus_seconds(seconds), &state, &used) !=
      LookupStatus::kOk) {
    return -1;
  }
  return used->issue;
}

constexpr SatelliteId kE11{System::kGalileo, 11};

void add_orbit(EphemerisStore* ephemeris_store, const Ephemeris& e, int first, int last,
               double step) {
  for (int i = first; i <= last; ++i) {
    const GpsTime t = kNoon.plus_seconds(i * step);
    REQUIRE(ephemeris_store->add(PreciseState{e.satellite, t, broadcast_state(e, t).p_e, 1e-5}));
  }
}

// The set number `i` of a satellite, every two hours.
Ephemeris set_of(SatelliteId id, int i) {
  Ephemeris e = gps(1, 7200.0 * i, static_cast<std::uint16_t>(i));
  e.satellite = id;
  if (id.system == System::kGalileo) e.message = NavigationMessage::kGalileoInav;
  if (id.system == System::kBeidou) e.message = NavigationMessage::kBeidouD1;
  if (id.system == System::kLeo) e.sqrt_a = 2734.0;
  return e;
}

}  // namespace

TEST_CASE("The elements with the nearest toe serve, within their age", "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  SatelliteState state;
  CHECK(ephemeris_store.state_at(kG05, kNoon, &state) == LookupStatus::kNoEphemeris);
  REQUIRE(ephemeris_store.add(gps(5, 7200, 2)));
  REQUIRE(ephemeris_store.add(gps(5, 0, 1)));  // out of order
  CHECK(issue_at(ephemeris_store, kG05, -7200) == 1);
  CHECK(issue_at(ephemeris_store, kG05, 3599) == 1);
  CHECK(issue_at(ephemeris_store, kG05, 3601) == 2);
  CHECK(issue_at(ephemeris_store, kG05, 14400) == 2);
  CHECK(ephemeris_store.state_at(kG05, kNoon.plus_seconds(14401), &state) == LookupStatus::kTooOld);
  CHECK(ephemeris_store.state_at(kG05, kNoon.plus_seconds(-7201), &state) == LookupStatus::kTooOld);
  CHECK(ephemeris_store.state_at({System::kGps, 6}, kNoon, &state) == LookupStatus::kNoEphemeris);
  REQUIRE(ephemeris_store.ephemeris_at(kG05, kNoon) != nullptr);
  CHECK(ephemeris_store.ephemeris_at(kG05, kNoon)->issue == 1);
  CHECK(ephemeris_store.ephemeris_at(kG05, kNoon.plus_seconds(1e6)) == nullptr);
}

TEST_CASE("Of one toe the later transmission serves; a repeated issue replaces",
          "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  Ephemeris late = gps(5, 0, 9);
  late.transmission_time = kNoon.plus_seconds(-60);
  REQUIRE(ephemeris_store.add(late));
  REQUIRE(ephemeris_store.add(gps(5, 0, 8)));
  CHECK(issue_at(ephemeris_store, kG05, 0) == 9);
  Ephemeris again = late;
  again.af0 = 1e-5;
  for (std::size_t i = 0; i < 3 * kMaxEphemeridesPerSatellite; ++i)
    REQUIRE(ephemeris_store.add(again));
  CHECK(ephemeris_store.ephemeris_at(kG05, kNoon)->af0 == 1e-5);
  CHECK(issue_at(ephemeris_store, kG05, 0) == 9);
}

TEST_CASE("Full, what arrived first goes, and wrong times do not block for good",
          "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  for (int i = 0; i < 16; ++i) {  // a day of nonsense far in the future
    REQUIRE(ephemeris_store.add(gps(5, 1e6 + 7200.0 * i, static_cast<std::uint16_t>(100 + i))));
  }
  for (int i = 0; i < 30; ++i) {
    REQUIRE(ephemeris_store.add(gps(5, 7200.0 * i, static_cast<std::uint16_t>(i))));
    CHECK(issue_at(ephemeris_store, kG05, 7200.0 * i) == i);
  }
  CHECK(issue_at(ephemeris_store, kG05, 7200.0 * 14) == 14);
  CHECK(issue_at(ephemeris_store, kG05, 7200.0 * 12) == -1);
}

TEST_CASE("Both Galileo messages an hour ahead leave the sets in force where they are",
          "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  int sent = 0;
  for (int now = 0; now < 36; ++now) {  // every ten minutes for six hours
    for (; sent <= now + 6; ++sent) {
      for (const NavigationMessage message :
           {NavigationMessage::kGalileoInav, NavigationMessage::kGalileoFnav}) {
        Ephemeris e = galileo(message, 600.0 * sent);
        e.issue = static_cast<std::uint16_t>(sent);
        REQUIRE(ephemeris_store.add(e));
      }
    }
    CHECK(issue_at(ephemeris_store, kE11, 600.0 * now) == now);
  }
}

TEST_CASE("However many sets come ahead, that in force stays", "[satellite_catalog]") {
  EphemerisStore store{EphemerisConfig{}};
  REQUIRE(store.add(gps(5, 0.0, 1)));
  for (int i = 1; i < 50; ++i) {
    CHECK(issue_at(store, kG05, 10.0 * i) == 1);
    REQUIRE(store.add(gps(5, 7200.0 * i, static_cast<std::uint16_t>(i + 1))));
  }
  CHECK(issue_at(store, kG05, 500.0) == 1);
}

TEST_CASE("Beyond the room for all satellites those with most lose the set that arrived first",
          "[satellite_catalog]") {
  EphemerisStore store{EphemerisConfig{}};
  const std::vector<SatelliteId> all = test::all_satellites();
  constexpr int kEach = static_cast<int>(kMaxEphemerides / kMaxEphemerisSatellites);
  const auto has = [&](SatelliteId id, int i) {
    const Ephemeris* found = store.ephemeris_at(id, kNoon.plus_seconds(7200.0 * i));
    return found != nullptr && found->issue == i;
  };
  for (int i = 0; i <= kEach; ++i)
    for (const SatelliteId id : all) REQUIRE(store.add(set_of(id, i)));
  // What the last round was more than the room for it has cost as many first sets, in their order.
  const std::size_t lost = (kEach + 1) * all.size() - kMaxEphemerides;
  REQUIRE(lost < all.size());
  for (std::size_t k = 0; k < all.size(); ++k) {
    CAPTURE(k);
    CHECK(has(all[k], 0) == (k >= lost));
    for (int i = 1; i <= kEach; ++i) CHECK(has(all[k], i));
  }
}

TEST_CASE("A catalogue larger than the store that comes twice leaves the sets in use",
          "[satellite_catalog]") {
  EphemerisStore store{EphemerisConfig{}};
  const std::vector<SatelliteId> all = test::all_satellites();
  const std::array in_use = {all.front(), all[80], all.back()};
  for (const SatelliteId id : all) REQUIRE(store.add(set_of(id, 0)));
  for (const SatelliteId id : in_use) REQUIRE(issue_at(store, id, 0.0) == 0);
  const int sets_each = GENERATE(8, 9);
  for (int round = 0; round < 2; ++round)
    for (int i = 0; i < sets_each; ++i)
      for (const SatelliteId id : all) REQUIRE(store.add(set_of(id, i)));
  for (const SatelliteId id : in_use) {
    CAPTURE(sets_each, to_string(id.system), id.number);
    CHECK(issue_at(store, id, 10.0) == 0);
  }
}

TEST_CASE("Beyond the room for all satellites the sets in use stay", "[satellite_catalog]") {
  EphemerisStore store{EphemerisConfig{}};
  const std::vector<SatelliteId> all = test::all_satellites();
  const std::array in_use = {all.front(), all[80], all.back()};
  for (int i = 0; i < 20; ++i) {
    for (const SatelliteId id : all) REQUIRE(store.add(set_of(id, i)));
    for (const SatelliteId id : in_use) {
      CAPTURE(i, to_string(id.system), id.number);
      CHECK(issue_at(store, id, 10.0 * i) == 0);
    }
  }
  CHECK(issue_at(store, all[1], 190.0) == -1);
}

TEST_CASE("Unhealthy satellites are out, by the newest message that was out by then",
          "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  SatelliteState state;
  REQUIRE(ephemeris_store.add(gps(5, 0, 1)));
  Ephemeris sick = gps(5, 7200, 2);
  sick.health = 1;
  sick.transmission_time = kNoon.plus_seconds(600);
  REQUIRE(ephemeris_store.add(sick));
  CHECK(ephemeris_store.state_at(kG05, kNoon, &state) == LookupStatus::kOk);
  // Still nearer to the healthy toe, but told by now.
  CHECK(ephemeris_store.state_at(kG05, kNoon.plus_seconds(700), &state) ==
        LookupStatus::kUnhealthy);
  CHECK(ephemeris_store.state_at(kG05, kNoon.plus_seconds(7200), &state) ==
        LookupStatus::kUnhealthy);
  REQUIRE(ephemeris_store.ephemeris_at(kG05, kNoon.plus_seconds(7200)) != nullptr);
}

TEST_CASE("Of one toe Galileo's preferred message serves, but never an older batch",
          "[satellite_catalog]") {
  for (const bool fnav : {false, true}) {
    EphemerisConfig options;
    options.galileo_prefers_fnav = fnav;
    EphemerisStore ephemeris_store(options);
    const auto preferred = fnav ? NavigationMessage::kGalileoFnav : NavigationMessage::kGalileoInav;
    const auto other = fnav ? NavigationMessage::kGalileoInav : NavigationMessage::kGalileoFnav;
    const auto add = [&](NavigationMessage message, double toe_s, std::uint16_t issue) {
      Ephemeris e = galileo(message, toe_s);
      e.issue = issue;
      REQUIRE(ephemeris_store.add(e));
    };
    add(other, 0, 1);
    CHECK(issue_at(ephemeris_store, kE11, 600) == 1);  // what there is
    add(preferred, 0, 2);
    CHECK(issue_at(ephemeris_store, kE11, 600) == 2);
    add(other, 600, 3);  // the next batch, told by the other message first
    CHECK(issue_at(ephemeris_store, kE11, 600) == 3);
    CHECK(issue_at(ephemeris_store, kE11, 0) == 2);
    CHECK(issue_at(ephemeris_store, kE11, 14000) == 3);
    add(preferred, 600, 4);
    CHECK(issue_at(ephemeris_store, kE11, 600) == 4);
    CHECK(issue_at(ephemeris_store, kE11, 14401) == 4);
    add(other, 14400, 5);  // four hours younger
    CHECK(issue_at(ephemeris_store, kE11, 14400) == 5);
  }
}

TEST_CASE("Precise states go before broadcast ones, and broadcast ones stand in",
          "[satellite_catalog]") {
  EphemerisConfig options;
  EphemerisStore ephemeris_store(options);
  const Ephemeris e = gps(5, 0, 1);
  SatelliteState state;
  const Ephemeris* used = &e;
  add_orbit(&ephemeris_store, e, -6, 6, 300.0);
  REQUIRE(ephemeris_store.state_at(kG05, kNoon.plus_seconds(120), &state, &used) ==
          LookupStatus::kOk);
  CHECK(state.source == OrbitSource::kPrecise);
  CHECK(used == nullptr);
  CHECK(ephemeris_store.state_at(kG05, kNoon.plus_seconds(3000), &state) == LookupStatus::kTooOld);

  REQUIRE(ephemeris_store.add(e));
  REQUIRE(ephemeris_store.state_at(kG05, kNoon.plus_seconds(120), &state, &used) ==
          LookupStatus::kOk);
  CHECK(state.source == OrbitSource::kPrecise);
  REQUIRE(ephemeris_store.state_at(kG05, kNoon.plus_seconds(3000), &state, &used) ==
          LookupStatus::kOk);
  CHECK(state.source == OrbitSource::kBroadcast);
  CHECK(used != nullptr);

  Ephemeris sick = e;
  sick.health = 63;
  REQUIRE(ephemeris_store.add(sick));
  CHECK(ephemeris_store.state_at(kG05, kNoon.plus_seconds(120), &state) ==
        LookupStatus::kUnhealthy);

  options.use_precise = false;
  EphemerisStore broadcast_only(options);
  add_orbit(&broadcast_only, e, -6, 6, 300.0);
  CHECK(broadcast_only.state_at(kG05, kNoon, &state) == LookupStatus::kNoEphemeris);
}

TEST_CASE("A precise state of the centre of mass is as sure as its antenna's place",
          "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  Ephemeris leo = gps(5, 0, 1);
  leo.satellite.system = System::kLeo;
  leo.sqrt_a = 2734.0;
  add_orbit(&ephemeris_store, gps(5, 0, 1), -6, 6, 300.0);
  add_orbit(&ephemeris_store, leo, -6, 6, 30.0);
  SatelliteState of_gps, of_leo;
  REQUIRE(ephemeris_store.state_at(kG05, kNoon, &of_gps) == LookupStatus::kOk);
  REQUIRE(ephemeris_store.state_at(leo.satellite, kNoon, &of_leo) == LookupStatus::kOk);
  CHECK(of_gps.sigma_m < 0.05);
  CHECK(of_leo.sigma_m < 0.05);
}

TEST_CASE("Nodes come in any order, repeat, and go on for ever", "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  const Ephemeris e = gps(5, 0, 1);
  SatelliteState state;
  const auto add = [&](int i, double clock_s) {
    const GpsTime t = kNoon.plus_seconds(300.0 * i);
    return ephemeris_store.add(PreciseState{e.satellite, t, broadcast_state(e, t).p_e, clock_s});
  };
  for (const int i : {3, -2, 5, 0, -4, 4, 1, -1, 2, -3, -5}) REQUIRE(add(i, 0.0));
  REQUIRE(ephemeris_store.state_at(kG05, kNoon.plus_seconds(100), &state) == LookupStatus::kOk);
  CHECK((state.p_e - broadcast_state(e, kNoon.plus_seconds(100)).p_e).norm() < 1e-3);
  const double before = state.clock_s;
  for (const int i : {0, 1}) REQUIRE(add(i, 1e-6));  // a corrected clock
  REQUIRE(ephemeris_store.state_at(kG05, kNoon.plus_seconds(100), &state) == LookupStatus::kOk);
  CHECK(state.clock_s - before == Approx(1e-6).epsilon(1e-6));

  // A stream that is eight nodes ahead of the present, over two days.
  for (int i = 6; i < 600; ++i) {
    REQUIRE(add(i, 0.0));
    const GpsTime present = kNoon.plus_seconds(300.0 * (i - 8) + 150.0);
    REQUIRE(ephemeris_store.state_at(kG05, present, &state) == LookupStatus::kOk);
    REQUIRE((state.p_e - broadcast_state(e, present).p_e).norm() < 1e-3);
  }
}

TEST_CASE("Bad input changes nothing", "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Ephemeris e = gps(5, 0, 1);
  e.m0 = nan;
  CHECK_FALSE(ephemeris_store.add(e));
  const Eigen::Vector3d p(2.6e7, 0, 0);
  CHECK_FALSE(ephemeris_store.add(PreciseState{kG05, GpsTime(), p, 0.0}));
  CHECK_FALSE(ephemeris_store.add(PreciseState{{System::kGps, 64}, kNoon, p, 0.0}));
  CHECK_FALSE(ephemeris_store.add(PreciseState{{static_cast<System>(9), 1}, kNoon, p, 0.0}));
  CHECK_FALSE(ephemeris_store.add(PreciseState{kG05, kNoon, Eigen::Vector3d::Zero(), 0.0}));
  CHECK_FALSE(ephemeris_store.add(PreciseState{kG05, kNoon, {nan, 0, 0}, 0.0}));
  CHECK_FALSE(ephemeris_store.add(PreciseState{kG05, kNoon, p, 999999.999999e-6}));
  CHECK_FALSE(
      ephemeris_store.add(PreciseState{kG05, kNoon, p, std::numeric_limits<double>::infinity()}));
  SatelliteState state;
  CHECK(ephemeris_store.state_at(kG05, kNoon, &state) == LookupStatus::kNoEphemeris);
  REQUIRE(ephemeris_store.add(gps(5, 0, 1)));
  for (const GpsTime t :
       {GpsTime(), GpsTime::from_nanoseconds(std::numeric_limits<std::int64_t>::min()),
        GpsTime::from_nanoseconds(std::numeric_limits<std::int64_t>::max())}) {
    CHECK(ephemeris_store.state_at(kG05, t, &state) != LookupStatus::kOk);
  }
  CHECK(ephemeris_store.state_at({static_cast<System>(250), 3}, kNoon, &state) ==
        LookupStatus::kNoEphemeris);
}

TEST_CASE("Every satellite has a place of its own", "[satellite_catalog]") {
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  const std::array<int, kSystemCount> highest = {63, 50, 63, 399};
  int count = 0;
  for (const System system : kSystems) {
    for (int n = 1; n <= highest[index_of(system)]; ++n) {
      const SatelliteId id{system, static_cast<std::uint16_t>(n)};
      for (int i = 0; i < 5; ++i) {
        const double angle = 1e-3 * count + 0.04 * i;
        const Eigen::Vector3d p(7e6 * std::cos(angle), 7e6 * std::sin(angle), 0.0);
        REQUIRE(
            ephemeris_store.add(PreciseState{id, kNoon.plus_seconds(40.0 * i), p, 1e-6 * count}));
      }
      ++count;
    }
  }
  CHECK(count == static_cast<int>(kMaxEphemerisSatellites));
  count = 0;
  for (const System system : kSystems) {
    for (int n = 1; n <= highest[index_of(system)]; ++n) {
      SatelliteState state;
      REQUIRE(ephemeris_store.state_at({system, static_cast<std::uint16_t>(n)},
                                       kNoon.plus_seconds(80.0), &state) == LookupStatus::kOk);
      CHECK(state.clock_s == Approx(1e-6 * count++).margin(1e-8));
    }
  }
}

}  // namespace leonav
