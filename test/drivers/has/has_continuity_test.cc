// The signs of HAS by what it corrects: where the broadcast message changes, it jumps by some
// decimetres, and the corrected satellite does not.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <vector>

#include "core/gnss/signals/signal.h"
#include "drivers/has/has_decoder.h"
#include "drivers/page_lines/page_file_reader.h"
#include "drivers/rinex/navigation_reader.h"
#include "drivers/ssr/orbit_correction.h"
#include "support/catch.h"
#include "support/pages/recorded_pages.h"
#include "support/recorded/shared_data.h"

namespace leonav {
namespace {

using test::kBroadcast;
using test::kHasPages;

// The newest corrections of a satellite, and the elements that they correct.
struct Satellite {
  SsrOrbit orbit;
  const Ephemeris* broadcast = nullptr;
  double clock_m = 0.0;
  GpsTime clock_time;
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

// Jumps at the changes of the broadcast message, with corrections times +1, 0, -1.
struct Jumps {
  std::map<int, std::vector<double>> position_m, clock_m;
};

CorrectedState state_of(const Satellite& satellite, int sign, GpsTime time) {
  OrbitAndClock corrections{satellite.orbit, time, {}, time, 0.0};
  corrections.orbit.delta_rac_m *= sign;
  corrections.clock.c0_m = sign * satellite.clock_m;
  return apply(corrections, *satellite.broadcast, time);
}

Jumps jumps_of_hour() {
  const NavigationFile navigation = read_navigation(test::shared_data(kBroadcast));
  const auto find = [&](SatelliteId id, const SsrOrbit& orbit) -> const Ephemeris* {
    for (const Ephemeris& e : navigation.ephemerides) {
      if (e.satellite == id && is_corrected_by(e, orbit, SsrService::kGalileoHas)) return &e;
    }
    return nullptr;
  };
  HasDecoder decoder;
  PageFileReader reader(test::shared_data(kHasPages), PageService::kGalileoHas);
  std::map<SatelliteId, Satellite> before, now;
  Jumps jumps;
  for (CorrectionPage page; reader.next(&page);) {
    for (const SsrMessage& message : decoder.add(page)) {
      for (const SsrSatellite& s : message.satellites) {
        Satellite& current = now[s.satellite];
        if (s.orbit) {
          if (s.orbit->issue != current.orbit.issue) before[s.satellite] = current;
          current.orbit = *s.orbit;
          current.broadcast = find(s.satellite, *s.orbit);
        }
        if (!s.clock) continue;
        current.clock_m = s.clock->c0_m;
        current.clock_time = message.time;
        // The first clock of the new message is compared with the last one of the old message.
        const auto old = before.find(s.satellite);
        if (old == before.end()) continue;
        const bool are_close = old->second.clock_time.is_set() &&
                               seconds_between(message.time, old->second.clock_time) < 30.0;
        if (are_close && old->second.broadcast != nullptr && current.broadcast != nullptr) {
          for (const int sign : {1, 0, -1}) {
            const CorrectedState a = state_of(old->second, sign, message.time);
            const CorrectedState b = state_of(current, sign, message.time);
            jumps.position_m[sign].push_back((a.p_e - b.p_e).norm());
            jumps.clock_m[sign].push_back(kSpeedOfLight * std::abs(a.clock_s - b.clock_s));
          }
        }
        before.erase(old);
      }
    }
  }
  return jumps;
}

}  // namespace

TEST_CASE("Corrected satellites go on where the broadcast message changes") {
  if (!test::have_shared_data(kHasPages) || !test::have_shared_data(kBroadcast)) return;
  Jumps jumps = jumps_of_hour();
  REQUIRE(jumps.position_m[1].size() > 20);
  for (auto* of : {&jumps.position_m, &jumps.clock_m}) {
    const double as_sent = median((*of)[1]), without = median((*of)[0]), other = median((*of)[-1]);
    std::cout << (of == &jumps.position_m ? "positions" : "clocks") << " of HAS at "
              << (*of)[1].size() << " changes of the broadcast message: jumps of " << 1e3 * as_sent
              << " mm, " << 1e3 * without << " mm without corrections, " << 1e3 * other
              << " mm with the other sign\n";
    CHECK(as_sent < 0.5 * without);
    CHECK(without < 0.7 * other);
  }
}

}  // namespace leonav
