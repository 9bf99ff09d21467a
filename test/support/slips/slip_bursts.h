// Slips of many satellites in one epoch, and skies with few satellites.
#pragma once
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "support/slips/slip_experiment.h"

namespace leonav::test {

struct SlipBursts {
  // Of `count` satellites whose arcs go on at an epoch, so many slip there.
  std::size_t (*slipping)(std::size_t count) = [](std::size_t) { return std::size_t{1}; };
  bool one_cycle = false;  // else 1 to 1000, small ones as likely as large ones; both signs
  std::size_t every = 5;   // epochs
};

// Of a pair slips the first carrier or the second, never both.
inline std::vector<Injection> draw_bursts(const std::vector<SlipRun::Going>& going,
                                          const SlipBursts& bursts, std::uint64_t seed) {
  std::map<std::size_t, std::vector<SlipRun::Going>> by_epoch;
  for (const SlipRun::Going& place : going) {
    if (place.epoch > 0 && place.epoch % bursts.every == 0) by_epoch[place.epoch].push_back(place);
  }
  std::mt19937_64 generator(seed);
  const auto below = [&](std::size_t limit) {
    return static_cast<std::size_t>(generator() % limit);
  };
  std::vector<Injection> injections;
  for (auto& [epoch, places] : by_epoch) {
    const std::size_t count = std::min(bursts.slipping(places.size()), places.size());
    for (std::size_t i = 0; i < count; ++i) {
      std::swap(places[i], places[i + below(places.size() - i)]);
      Injection slip{epoch, places[i].satellite, 0, 0, false};
      int cycles = 1;
      if (!bursts.one_cycle) {
        cycles = static_cast<int>(
            std::lround(std::pow(1000.0, static_cast<double>(below(10'001)) / 10'000.0)));
      }
      if (below(2) == 0) cycles = -cycles;
      (places[i].pair && below(2) == 0 ? slip.second : slip.first) = cycles;
      injections.push_back(slip);
    }
  }
  return injections;
}

// Leaves of every epoch the `count` satellites, none in low orbit, that are tracked longest above
// the mask; the last named of those tracked as long.
inline void leave_satellites(std::size_t count, const std::vector<SlipRun::Going>& going,
                             std::vector<RawEpoch>* epochs) {
  std::map<SatelliteId, std::size_t> tracked;
  for (const SlipRun::Going& place : going) {
    if (place.satellite.system != System::kLeo) ++tracked[place.satellite];
  }
  std::vector<std::pair<std::size_t, SatelliteId>> longest;
  for (const auto& [satellite, n] : tracked) longest.push_back({n, satellite});
  std::sort(longest.rbegin(), longest.rend());
  std::set<SatelliteId> kept;
  for (const auto& [n, satellite] : longest) {
    if (kept.size() < count) kept.insert(satellite);
  }
  for (RawEpoch& raw : *epochs) {
    raw.observations.erase(
        std::remove_if(raw.observations.begin(), raw.observations.end(),
                       [&](const SignalObservation& o) { return kept.count(o.satellite) == 0; }),
        raw.observations.end());
  }
}

}  // namespace leonav::test
