#include "tools/sim/run/sky_statistics.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <numeric>
#include <ostream>
#include <stdexcept>

#include "core/gnss/measurement/dop.h"
#include "core/gnss/measurement/look_angles.h"
#include "tools/sim/route/drive.h"
#include "tools/sim/signals/receiver.h"
#include "tools/sim/signals/signal_plan.h"

namespace leonav::sim {
namespace {

std::vector<SystemCombination> combinations() {
  const System G = System::kGps, E = System::kGalileo, C = System::kBeidou, L = System::kLeo;
  return {{"gps", {G}},
          {"galileo", {E}},
          {"beidou", {C}},
          {"leo", {L}},
          {"gps+leo", {G, L}},
          {"beidou+leo", {C, L}},
          {"gps+gal+bds", {G, E, C}},
          {"gps+gal+bds+leo", {G, E, C, L}}};
}

using Positions = std::map<SatelliteId, Eigen::Vector3d>;  // ECEF, m

void add_epoch(const Positions& satellites, const Eigen::Vector3d& p_a_e,
               const SystemCombination& combination, MeasurementEpoch* scratch, SkySeries* series) {
  scratch->satellites.clear();
  for (const auto& [id, p_e] : satellites) {
    const auto& systems = combination.systems;
    if (std::find(systems.begin(), systems.end(), id.system) == systems.end()) continue;
    if (scratch->satellites.size() == scratch->satellites.capacity()) break;
    SatelliteInView satellite;
    satellite.satellite = id;
    satellite.p_e = p_e;
    scratch->satellites.push_back(satellite);
  }
  std::bitset<kMaxSatellites> used;
  for (std::size_t i = 0; i < scratch->satellites.size(); ++i) used.set(i);
  series->satellites.push_back(static_cast<double>(scratch->satellites.size()));
  const double pdop = dilution_of_precision(*scratch, used, p_a_e).pdop;
  if (std::isfinite(pdop)) series->pdop.push_back(pdop);
}

// Returns the satellites with a pseudorange on every signal of their system.
Positions tracked_of(const Scenario& scenario, const RawEpoch& epoch, const Positions& in_the_sky) {
  std::map<SatelliteId, std::size_t> ranges;
  for (const SignalObservation& o : epoch.observations) {
    if (std::isfinite(o.pseudorange_m)) ++ranges[o.satellite];
  }
  Positions tracked;
  for (const auto& [id, p_e] : in_the_sky) {
    if (ranges[id] >= signals_of(scenario, id.system).size()) tracked[id] = p_e;
  }
  return tracked;
}

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// Returns the value nearest to the quantile `share` (0 to 1). Precondition: there is one.
double nearest_quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

// Returns the papers' means: satellites and PDOP.
std::string published(const std::string& name) {
  static const std::map<std::string, std::string> numbers = {{"gps", "6.5 / 4.3    7.0 / 3.4"},
                                                             {"beidou", "12.8 / 4.1"},
                                                             {"leo", "             9.5 / 2.0"},
                                                             {"gps+leo", "13.4 / 1.9   16.5 / 1.1"},
                                                             {"beidou+leo", "19.6 / 2.1"}};
  const auto place = numbers.find(name);
  return place == numbers.end() ? "" : place->second;
}

void print_table(const std::vector<SystemCombination>& names, const std::vector<SkySeries>& series,
                 bool with_papers, std::ostream& stream) {
  const auto line = [&stream](const char* format, auto... values) {
    char text[200];
    std::snprintf(text, sizeof text, format, values...);
    stream << text;
  };
  line("  %-16s%30s  %38s  %s%s\n", "", "satellites", "PDOP", "no PDOP",
       with_papers ? "   RS 2024      El. 2024" : "");
  line("  %-16s%6s%6s%6s%6s%6s  %7s%7s%6s%6s%6s%6s\n", "", "mean", "min", "5 %", "95 %", "max",
       "mean", "min", "50 %", "75 %", "95 %", "max");
  for (std::size_t i = 0; i < names.size(); ++i) {
    const std::vector<double>&n = series[i].satellites, &p = series[i].pdop;
    if (n.empty() || nearest_quantile(n, 1.0) == 0.0) continue;
    line("  %-16s%6.1f%6.0f%6.0f%6.0f%6.0f", names[i].name.c_str(), mean(n),
         nearest_quantile(n, 0.0), nearest_quantile(n, 0.05), nearest_quantile(n, 0.95),
         nearest_quantile(n, 1.0));
    if (p.empty()) {
      line("  %38s", "-");
    } else {
      line("  %7.1f%7.1f%6.1f%6.1f%6.1f%6.0f", mean(p), nearest_quantile(p, 0.0),
           nearest_quantile(p, 0.5), nearest_quantile(p, 0.75), nearest_quantile(p, 0.95),
           nearest_quantile(p, 1.0));
    }
    const double without = 1.0 - static_cast<double>(p.size()) / static_cast<double>(n.size());
    line("  %5.1f %%   %s\n", 100.0 * without, with_papers ? published(names[i].name).c_str() : "");
  }
}

}  // namespace

SkyStatistics sky_statistics(const Scenario& scenario, double mask, double step_s) {
  SkyStatistics statistics;
  statistics.combinations = combinations();
  statistics.in_the_sky.resize(statistics.combinations.size());
  statistics.tracked.resize(statistics.combinations.size());
  const SplineMotion motion = drive(scenario);
  const TrueSky sky = build_sky(scenario);
  const FaultScript faults(scenario.faults);
  Receiver receiver(scenario, motion, sky, faults);
  const auto scratch = std::make_unique<MeasurementEpoch>();
  for (double t = step_s; t < motion.duration_s() - 1.0; t += step_s) {
    const Eigen::Vector3d p_a_e =
        antenna_at(motion, scenario.receiver.lever_arm_b, Eigen::Vector3d::Zero(), t).p_e;
    Positions up;
    for (const TrueSatellite& satellite : sky.satellites) {
      const Eigen::Vector3d p_e = to_earth(satellite.orbit.at(t).p_i, t);
      if (look_angles(p_e, p_a_e).elevation >= mask) up[satellite.id] = p_e;
    }
    const Positions tracked = tracked_of(scenario, receiver.epoch(t), up);
    for (std::size_t i = 0; i < statistics.combinations.size(); ++i) {
      const SystemCombination& combination = statistics.combinations[i];
      add_epoch(up, p_a_e, combination, scratch.get(), &statistics.in_the_sky[i]);
      add_epoch(tracked, p_a_e, combination, scratch.get(), &statistics.tracked[i]);
    }
  }
  if (statistics.tracked.front().satellites.empty()) {
    throw std::runtime_error("no epoch to count: the drive is shorter than a step and a second");
  }
  return statistics;
}

void print(const SkyStatistics& statistics, std::ostream& stream) {
  stream << "in the sky, above the mask\n";
  print_table(statistics.combinations, statistics.in_the_sky, false, stream);
  stream << "tracked on every signal; papers' means, satellites / PDOP\n";
  print_table(statistics.combinations, statistics.tracked, true, stream);
}

}  // namespace leonav::sim
