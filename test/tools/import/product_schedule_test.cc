// Orbit products of different intervals in one schedule, through the ephemeris store that they
// feed.
#include "tools/import/product_schedule.h"

#include <cmath>
#include <memory>

#include "core/gnss/orbits/ephemeris_store.h"
#include "support/catch.h"

using namespace leonav;

namespace {

const GpsTime kThursday = GpsTime::from_week_and_tow(2200, 345'600.0);
const SatelliteId kGps7{System::kGps, 7}, kLeo12{System::kLeo, 12};

// A circular orbit in the inertial frame that equals ECEF at kThursday, seen from the turning
// Earth.
PreciseState on_circle(SatelliteId id, double t) {
  const double radius = id.system == System::kLeo ? 7'478e3 : 26'560e3;
  const double angle = std::sqrt(3.986004418e14 / radius) / radius * t;
  const double turned = 7.2921151467e-5 * t;
  const double x = radius * std::cos(angle), y = 0.6 * radius * std::sin(angle);
  PreciseState state;
  state.satellite = id;
  state.time = kThursday.plus_seconds(t);
  state.p_e = {std::cos(turned) * x + std::sin(turned) * y,
               std::cos(turned) * y - std::sin(turned) * x, 0.8 * radius * std::sin(angle)};
  state.clock_s = 1e-5;
  return state;
}

void append_product(SatelliteId id, double from_s, double to_s, double step_s,
                    std::vector<OrbitEpoch>* epochs) {
  for (double t = from_s; t <= to_s; t += step_s) {
    epochs->push_back({kThursday.plus_seconds(t), {on_circle(id, t)}});
  }
}

// Seconds of [from, to) at which the satellite has no precise state, and the worst error.
struct Availability {
  int missing = 0;
  double worst_m = 0.0;
};

struct Replay {
  explicit Replay(std::vector<ScheduledOrbitEpoch> items) : schedule(std::move(items)) {}
  void advance(GpsTime now) {
    for (; next < schedule.size() && schedule[next].arrival <= now; ++next) {
      for (const PreciseState& state : schedule[next].epoch.states)
        REQUIRE(ephemeris_store.add(state));
    }
  }
  void look_up(SatelliteId id, double t, Availability* found) const {
    SatelliteState state;
    if (ephemeris_store.state_at(id, kThursday.plus_seconds(t), &state) != LookupStatus::kOk) {
      ++found->missing;
    } else {
      found->worst_m = std::max(found->worst_m, (state.p_e - on_circle(id, t).p_e).norm());
    }
  }
  std::vector<ScheduledOrbitEpoch> schedule;
  EphemerisStore ephemeris_store{EphemerisConfig{}};
  std::size_t next = 0;
};

}  // namespace

TEST_CASE("a GNSS product of 900 s and a LEO product of 30 s are both there at every instant",
          "[import]") {
  std::vector<OrbitEpoch> epochs;
  append_product(kGps7, -21'600.0, 32'400.0, 900.0, &epochs);
  append_product(kLeo12, -21'600.0, 32'400.0, 30.0, &epochs);
  // The recording starts between two nodes of either.
  Replay replay(schedule_orbits(epochs, kThursday.plus_seconds(407.0), kOrbitNodesAhead));
  Availability gps, leo;
  for (double t = 407.0; t < 407.0 + 10'800.0; t += 1.0) {
    replay.advance(kThursday.plus_seconds(t));
    replay.look_up(kGps7, t - 0.08, &gps);
    replay.look_up(kLeo12, t - 0.005, &leo);
  }
  CAPTURE(gps.worst_m, leo.worst_m);
  CHECK(gps.missing == 0);
  CHECK(leo.missing == 0);
  CHECK(gps.worst_m < 0.01);
  CHECK(leo.worst_m < 0.01);
}

TEST_CASE("a product whose interval changes with the day goes on without a hole", "[import]") {
  std::vector<OrbitEpoch> epochs;
  append_product(kGps7, -21'600.0, 3'600.0, 900.0, &epochs);
  append_product(kGps7, 3'900.0, 32'400.0, 300.0, &epochs);
  Replay replay(schedule_orbits(epochs, kThursday, kOrbitNodesAhead));
  Availability gps;
  for (double t = 0.0; t < 10'800.0; t += 1.0) {
    replay.advance(kThursday.plus_seconds(t));
    replay.look_up(kGps7, t - 0.08, &gps);
  }
  CAPTURE(gps.worst_m);
  CHECK(gps.missing == 0);
  CHECK(gps.worst_m < 0.01);
}

TEST_CASE("a satellite with one node, and no nodes at all", "[import]") {
  CHECK(schedule_orbits({}, kThursday, kOrbitNodesAhead).empty());
  const auto ahead = schedule_orbits({{kThursday.plus_seconds(60.0), {on_circle(kLeo12, 60.0)}}},
                                     kThursday, kOrbitNodesAhead);
  REQUIRE(ahead.size() == 1);
  CHECK(ahead[0].arrival == kThursday.plus_seconds(60.0));
  CHECK(schedule_orbits({{kThursday, {on_circle(kLeo12, 0.0)}}}, kThursday, kOrbitNodesAhead)
            .empty());
}
