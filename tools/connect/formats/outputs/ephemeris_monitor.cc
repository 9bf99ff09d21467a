#include "tools/connect/formats/outputs/ephemeris_monitor.h"

#include <map>
#include <set>
#include <string_view>
#include <vector>

#include "tools/common/format.h"
#include "tools/common/system_name.h"

namespace leonav {
namespace {

// Writes a list as "a, b and c".
std::string enumerated(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    text += (i == 0 ? "" : i + 1 == parts.size() ? " and " : ", ") + parts[i];
  }
  return text;
}

}  // namespace

void EphemerisMonitor::on_epoch(const RawEpoch& epoch) {
  if (remedy_ == nullptr) return;
  std::set<SatelliteId> observed;
  for (const SignalObservation& o : epoch.observations) observed.insert(o.satellite);
  std::array<std::size_t, kSystemCount> satellites = {};
  for (const SatelliteId satellite : observed) ++satellites[index_of(satellite.system)];
  for (const System system : kSystems) look_at(system, satellites[index_of(system)], epoch.time);
}

void EphemerisMonitor::look_at(System system, std::size_t satellites, GpsTime time) {
  OfSystem& s = systems_[index_of(system)];
  const bool was_observed = s.satellites > 0;
  s.satellites = satellites;
  if (!orbits_->is_expected(system) || orbits_->has_any(system, time)) {
    s = OfSystem();
    s.satellites = satellites;
  } else if (s.observed.is_set()) {
    const double apart_s = seconds_between(time, s.observed);
    if (apart_s > kLongestInterval_s) {
      s.waited_s = 0.0;
    } else if (was_observed && satellites > 0) {
      s.waited_s += apart_s;
    }
  }
  if (satellites > 0) s.observed = time;
  s.is_without = satellites > 0 && s.waited_s >= kPatience_s;
}

void EphemerisMonitor::start_over() {
  for (OfSystem& system : systems_) {
    system.observed = {};
    system.waited_s = 0.0;
    system.is_without = false;
  }
}

// Systems with the same remedy share a sentence.
std::string EphemerisMonitor::text() const {
  std::vector<std::string_view> remedies;
  std::map<std::string_view, std::vector<std::string>> satellites;
  for (const System system : kSystems) {
    const OfSystem& s = systems_[index_of(system)];
    if (!s.is_without) continue;
    const std::string_view remedy = remedy_(system);
    if (satellites[remedy].empty()) remedies.push_back(remedy);
    satellites[remedy].push_back(format("%zu %s", s.satellites, name_of(system)));
  }
  std::string text;
  for (const std::string_view remedy : remedies) {
    text += (text.empty() ? "" : "; ") + enumerated(satellites[remedy]) +
            " satellites without an ephemeris: " + std::string(remedy);
  }
  // Nothing here sees what others send to leonavd.
  if (!text.empty()) {
    text += " (unless another program sends their orbits: warn_without_ephemerides)";
  }
  return text;
}

std::string EphemerisMonitor::take_news() {
  bool is_new = false;
  for (OfSystem& system : systems_) {
    if (!system.is_without || system.is_told) continue;
    system.is_told = true;
    is_new = true;
  }
  return is_new ? text() : "";
}

}  // namespace leonav
