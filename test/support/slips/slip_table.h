// Draws where carriers are made to slip, and prints what a run found as a line of a table.
#pragma once
#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "support/slips/slip_experiment.h"

namespace leonav::test {

// Slips at random places of a run without any: a share of them on one frequency, the rest on both,
// pairs that one combination or the other hardly sees included. `apart`: least number of epochs
// between two slips of a satellite.
inline std::vector<Injection> draw_injections(const std::vector<SlipRun::Going>& going,
                                              double share, std::size_t apart, std::uint64_t seed,
                                              bool flagged = false) {
  static constexpr int kPairs[][2] = {
      {1, 1}, {2, 2}, {3, 3}, {5, 5},  {10, 10}, {77, 60}, {9, 7},   {7, 9},   {5, 4},    {4, 3},
      {4, 5}, {1, 2}, {2, 1}, {1, -1}, {8, 6},   {14, 11}, {18, 14}, {60, 77}, {154, 120}};
  std::mt19937_64 generator(seed);
  const auto below = [&](std::size_t limit) {
    return static_cast<std::size_t>(generator() % limit);
  };
  std::vector<Injection> injections;
  std::map<SatelliteId, std::size_t> last;
  for (const SlipRun::Going& place : going) {
    if (below(100'000) >= static_cast<std::size_t>(share * 100'000.0)) continue;
    const auto before = last.find(place.satellite);
    if (before != last.end() && place.epoch < before->second + apart) continue;
    last[place.satellite] = place.epoch;
    Injection slip{place.epoch, place.satellite, 0, 0, flagged};
    // 1 to 1000, small ones as likely as large ones.
    const auto size = [&] {
      const int cycles = static_cast<int>(
          std::lround(std::pow(1000.0, static_cast<double>(below(10'001)) / 10'000.0)));
      return below(2) == 0 ? cycles : -cycles;
    };
    const std::size_t kind = place.pair ? below(5) : 0;
    if (kind == 0) slip.first = size();
    if (kind == 1) slip.second = size();
    if (kind == 2) slip.first = slip.second = size();
    if (kind >= 3) {
      const auto& pair = kPairs[below(std::size(kPairs))];
      const int sign = below(2) == 0 ? 1 : -1;
      slip.first = sign * pair[0];
      slip.second = sign * pair[1];
    }
    injections.push_back(slip);
  }
  return injections;
}

// A clean run, then one with slips; `none` (may be nullptr): what the clean one counted.
inline SlipCounts run_with_slips(const SlipScene& scene, const CycleSlipConfig& config,
                                 double share, bool flagged = false, SlipCounts* none = nullptr) {
  SlipRun clean(scene, config);
  const SlipCounts without = clean.run();
  if (none != nullptr) *none = without;
  const auto slips = draw_injections(clean.going(), share, 3, 7, flagged);
  return SlipRun(scene, config).run(slips);
}

inline void print_heading() {
  std::cout << std::left << std::setw(46) << "" << std::right << std::setw(9) << "slips"
            << std::setw(10) << "at once" << std::setw(7) << "late" << std::setw(8) << "missed"
            << std::setw(10) << "sat-ep." << std::setw(13) << "false/1000" << std::setw(15)
            << "too weak/1000" << '\n';
}

inline void print_counts(const std::string& name, const SlipCounts& c) {
  std::cout << std::left << std::setw(46) << name << std::right << std::setw(9) << c.injected
            << std::setw(8) << std::fixed << std::setprecision(2) << 100.0 * c.detected() << " %"
            << std::setw(7) << c.late << std::setw(8) << c.injected - c.at_once - c.late
            << std::setw(10) << c.satellite_epochs << std::setw(13) << std::setprecision(3)
            << 1000.0 * c.false_rate() << std::setw(15) << 1000.0 * c.too_weak_rate() << '\n'
            << std::defaultfloat;
}

inline void print_ends(const SlipCounts& c) {
  std::cout << "    arcs " << c.arcs << ", first of a satellite " << c.first_arcs << "; ended by:";
  for (const auto& [cause, n] : c.ends) {
    if (n > 0) std::cout << ' ' << to_string(cause) << ' ' << n;
  }
  std::cout << "; undecidable epochs " << c.undecidable << ", clock jumps " << c.clock_jumps
            << '\n';
}

inline void print_shares(const SlipCounts& c) {
  std::cout << "    found by:";
  for (const auto& [cause, n] : c.share) {
    if (n > 0) {
      std::cout << ' ' << to_string(cause) << ' ' << std::fixed << std::setprecision(1)
                << 100.0 * static_cast<double>(n) / std::max(1L, c.at_once) << " %";
    }
  }
  if (c.false_alarms > 0) std::cout << "; false:";
  for (const auto& [cause, n] : c.false_share) {
    if (n > 0) std::cout << ' ' << to_string(cause) << ' ' << n;
  }
  std::cout << "\n    of kind:";
  for (const auto& [kind, n] : c.by_kind) {
    std::cout << ' ' << kind << ' ' << n.first << '/' << n.second << ';';
  }
  std::cout << '\n' << std::defaultfloat;
}

}  // namespace leonav::test
