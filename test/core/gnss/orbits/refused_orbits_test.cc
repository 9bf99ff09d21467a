// Precise orbits that are metres from the broadcast ones are not used.
#include <algorithm>
#include <iostream>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/gnss/orbits/ephemeris_store.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/sp3/sp3_reader.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"
#include "support/sky/simulated_sky.h"

namespace leonav::test {
namespace {

using Eigen::Vector3d;

GpsTime at_s(double s) { return kSkyEpoch.plus_seconds(s); }

// The unit vector along the satellite's velocity relative to the Earth.
Vector3d along(const Ephemeris& e, GpsTime time) {
  return broadcast_state(e, time).v_e.normalized();
}

// A satellite with broadcast elements and precise states every 30 s that are off along its track
// between 300 s and 600 s.
struct Satellite {
  EphemerisStore store;
  Ephemeris ephemeris;

  explicit Satellite(double off_m, const Walker& walker = gps_walker(), bool broadcast = true,
                     const EphemerisConfig& config = {})
      : store(config), ephemeris(walker_ephemerides(walker).front()) {
    if (broadcast) REQUIRE(store.add(ephemeris));
    for (int s = 0; s <= 900; s += 30) {
      PreciseState node = product_node(ephemeris, at_s(s));
      if (s >= 300 && s <= 600) node.p_e += off_m * along(ephemeris, at_s(s));
      REQUIRE(store.add(node));
    }
  }
  bool refuse(double s) { return store.refuse_wrong_orbit(ephemeris.satellite, at_s(s)); }
  bool is_refused(double s) const { return store.is_orbit_refused(ephemeris.satellite, at_s(s)); }
  LookupStatus look(double s, SatelliteState* state) const {
    return store.state_at(ephemeris.satellite, at_s(s), state);
  }
  OrbitSource source(double s) const {
    SatelliteState state;
    CHECK(look(s, &state) == LookupStatus::kOk);
    return state.source;
  }
};

// A corrected state of `s`, off by `off_m` along its track.
CorrectedState corrected_of(const Ephemeris& e, double s, double off_m) {
  const SatelliteState broadcast = broadcast_state(e, at_s(s));
  CorrectedState corrected;
  corrected.satellite = e.satellite;
  corrected.time = corrected.corrected_at = corrected.orbit_corrected_at = at_s(s);
  corrected.p_e = broadcast.p_e + off_m * along(e, at_s(s));
  corrected.v_e = broadcast.v_e;
  corrected.clock_s = broadcast.clock_s;
  corrected.sigma_m = 0.1;
  return corrected;
}

}  // namespace

TEST_CASE("a precise orbit 15 m off is refused once, and used again when it is good") {
  Satellite satellite(15.0);
  CHECK_FALSE(satellite.refuse(100.0));
  CHECK(satellite.source(100.0) == OrbitSource::kPrecise);
  CHECK(satellite.refuse(450.0));
  CHECK_FALSE(satellite.refuse(450.5));  // too soon
  CHECK_FALSE(satellite.refuse(451.0));  // told already
  CHECK(satellite.is_refused(451.0));
  SatelliteState state;
  REQUIRE(satellite.look(451.0, &state) == LookupStatus::kOk);
  CHECK(state.source == OrbitSource::kBroadcast);
  CHECK((state.p_e - broadcast_state(satellite.ephemeris, at_s(451.0)).p_e).norm() < 1e-9);
  CHECK_FALSE(satellite.refuse(850.0));
  CHECK(satellite.source(850.0) == OrbitSource::kPrecise);
}

TEST_CASE("a refused orbit must come nearer than half the limit, whatever the order of time") {
  Satellite satellite(7.0);
  CHECK_FALSE(satellite.refuse(450.0));
  Satellite worse(12.0);
  CHECK(worse.refuse(450.0));
  for (int s = 300; s <= 600; s += 30) {  // corrected later on
    PreciseState node = product_node(worse.ephemeris, at_s(s));
    node.p_e += 7.0 * along(worse.ephemeris, at_s(s));
    REQUIRE(worse.store.add(node));
  }
  CHECK_FALSE(worse.refuse(448.0));
  CHECK(worse.is_refused(448.0));
  CHECK_FALSE(worse.refuse(100.0));
  CHECK_FALSE(worse.is_refused(100.0));
}

TEST_CASE("without broadcast elements a precise orbit is used unchecked") {
  Satellite satellite(15.0, gps_walker(), false);
  CHECK_FALSE(satellite.refuse(450.0));
  CHECK(satellite.source(450.0) == OrbitSource::kPrecise);
  // Of elements of another day nothing is known either.
  Ephemeris old = satellite.ephemeris;
  old.toe = old.toc = old.toe.plus_seconds(-86'400.0);
  REQUIRE(satellite.store.add(old));
  CHECK_FALSE(satellite.refuse(452.0));
}

TEST_CASE("a refused orbit serves again where the broadcast elements have become too old") {
  EphemerisConfig config;
  config.max_age_gps_s = 500.0;
  Satellite satellite(15.0, gps_walker(), true, config);
  REQUIRE(satellite.refuse(450.0));
  CHECK(satellite.source(499.0) == OrbitSource::kBroadcast);
  CHECK_FALSE(satellite.refuse(550.0));
  CHECK_FALSE(satellite.is_refused(550.0));
  CHECK(satellite.source(550.0) == OrbitSource::kPrecise);
}

TEST_CASE("a corrected state 15 m off is refused as a precise one is, as soon as it comes") {
  Satellite satellite(0.0);
  for (const double off_m : {3.0, 15.0}) {
    REQUIRE(satellite.store.add(corrected_of(satellite.ephemeris, 450.0, off_m)));
    CHECK(satellite.refuse(450.0 + 0.01 * off_m) == (off_m > 10.0));
  }
  CHECK(satellite.is_refused(450.2));
}

TEST_CASE("an orbit is compared again with every epoch at 1 Hz, however its stamps drift") {
  Satellite satellite(0.0);
  CorrectedState corrected = corrected_of(satellite.ephemeris, 450.0, 8.0);
  corrected.v_e += 5.0 * along(satellite.ephemeris, at_s(450.0));  // it drifts away
  REQUIRE(satellite.store.add(corrected));
  CHECK_FALSE(satellite.refuse(450.0));
  CHECK_FALSE(satellite.refuse(450.6));  // too soon
  CHECK(satellite.refuse(450.95));
}

TEST_CASE("a gap of the product neither counts as refused nor makes a bad orbit good") {
  Satellite satellite(0.0);
  const double first_s = 2000.0;  // no precise states there
  REQUIRE(satellite.store.add(corrected_of(satellite.ephemeris, first_s, 12.0)));
  CHECK(satellite.refuse(first_s));
  CHECK(satellite.is_refused(first_s));
  const double gap_s = first_s + 100.0;  // older than corrections may be
  CHECK_FALSE(satellite.refuse(gap_s));
  CHECK_FALSE(satellite.is_refused(gap_s));
  const double again_s = first_s + 200.0;
  REQUIRE(satellite.store.add(corrected_of(satellite.ephemeris, again_s, 7.0)));
  CHECK_FALSE(satellite.refuse(again_s));
  CHECK(satellite.is_refused(again_s));
  CHECK(satellite.source(again_s) == OrbitSource::kBroadcast);
  REQUIRE(satellite.store.add(corrected_of(satellite.ephemeris, again_s, 4.0)));
  CHECK_FALSE(satellite.refuse(again_s));
  CHECK_FALSE(satellite.is_refused(again_s));
}

TEST_CASE("BeiDou's orbits, which are not measured, may differ by 30 m") {
  for (const double off_m : {25.0, 35.0}) {
    Satellite satellite(off_m, beidou_walker());
    CHECK(satellite.refuse(450.0) == (off_m > 30.0));
  }
}

TEST_CASE("an orbit of a LEO satellite is not compared") {
  Satellite satellite(15.0, leo_walker());
  CHECK_FALSE(satellite.refuse(450.0));
  CHECK_FALSE(satellite.is_refused(450.0));
}

// Every state of the recorded products, as it is and 15 m off.
TEST_CASE("No orbit of three recorded days is refused, and nearly each that is 15 m off",
          "[data]") {
  struct Day {
    const char* navigation;
    std::vector<const char*> orbits;
  };
  for (const Day& day :
       {Day{"station/ESBC00DNK_2020177.nav",
            {"station/GRG0MGXFIN_2020176_15M.sp3", "station/GRG0MGXFIN_2020177_15M.sp3"}},
        Day{"drive/gps_day.nav", {"drive/COD0MGXFIN_20211180000_05M_ORB.SP3"}}}) {
    if (!have_shared_data(day.navigation)) continue;
    auto ephemerides = read_navigation(shared_data(day.navigation)).ephemerides;
    std::stable_sort(ephemerides.begin(), ephemerides.end(), [](const auto& a, const auto& b) {
      return a.transmission_time < b.transmission_time;
    });
    std::vector<Sp3Epoch> epochs;
    for (const char* path : day.orbits)
      for (const Sp3Epoch& epoch : read_sp3(shared_data(path)).epochs) epochs.push_back(epoch);
    for (const double off_m : {0.0, 15.0}) {
      EphemerisStore store{EphemerisConfig{}};
      EphemerisConfig broadcast_only;
      broadcast_only.use_precise = false;
      EphemerisStore elements(broadcast_only);
      auto next = ephemerides.begin();
      std::map<System, double> worst_m;
      int compared = 0, refused = 0;
      constexpr std::size_t kAhead = 8;
      for (std::size_t k = 0; k < epochs.size(); ++k) {
        const GpsTime t = epochs[k].states.front().time;
        for (; next != ephemerides.end() && next->transmission_time <= t; ++next) {
          store.add(*next);
          elements.add(*next);
        }
        for (PreciseState state : epochs[k].states) {
          if (off_m > 0.0) state.p_e += off_m * state.p_e.unitOrthogonal();
          store.add(state);
        }
        if (k < kAhead) continue;
        for (const PreciseState& node : epochs[k - kAhead].states) {
          SatelliteState broadcast, precise;
          if (elements.state_at(node.satellite, node.time, &broadcast) != LookupStatus::kOk)
            continue;
          if (broadcast.age_s > 3600.0) continue;  // not compared
          store.refuse_wrong_orbit(node.satellite, node.time);
          if (store.state_at(node.satellite, node.time, &precise) != LookupStatus::kOk) continue;
          const bool is_refused = store.is_orbit_refused(node.satellite, node.time);
          // Where nodes are missing there is no precise state.
          if (precise.source != OrbitSource::kPrecise && !is_refused) continue;
          ++compared;
          refused += is_refused;
          if (off_m > 0.0) continue;
          double& worst = worst_m[node.satellite.system];
          worst = std::max(worst, (precise.p_e - broadcast.p_e).norm());
        }
      }
      for (const auto& [system, worst] : worst_m)
        std::cout << day.navigation << ", " << to_string(system)
                  << ": precise less broadcast orbit at most " << worst << " m\n";
      std::cout << day.navigation << ", " << off_m << " m off: " << refused << " of " << compared
                << " states refused\n";
      REQUIRE(compared > 1500);
      if (off_m == 0.0)
        CHECK(refused == 0);
      else  // the broadcast orbit may be metres off in the same direction
        CHECK(refused > 0.98 * compared);
    }
  }
}

}  // namespace leonav::test
