#include "tools/import/product_schedule.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace leonav {
namespace {

bool is_valid_at(const Ephemeris& e, GpsTime time) {
  const System system = e.satellite.system;
  const double max_age_s =
      system == System::kLeo ? kLongestLeoAge_s : EphemerisConfig().max_age_s(system);
  return std::abs(seconds_between(time, e.toe)) <= max_age_s;
}

// Returns the time of a satellite's node `i`, extrapolated with the same step before the first and
// past the last one. Precondition: `times` is not empty.
GpsTime node_time(const std::vector<GpsTime>& times, std::ptrdiff_t i) {
  const auto count = static_cast<std::ptrdiff_t>(times.size());
  const auto at = [&](std::ptrdiff_t k) { return times[static_cast<std::size_t>(k)]; };
  if (i >= 0 && i < count) return at(i);
  if (count < 2) return at(0);
  const bool before = i < 0;
  const GpsTime end = before ? at(0) : at(count - 1);
  const std::int64_t step = before ? at(1).nanoseconds() - at(0).nanoseconds()
                                   : at(count - 1).nanoseconds() - at(count - 2).nanoseconds();
  return end.plus_nanoseconds((before ? i : i - (count - 1)) * step);
}

// Sorts by time and merges nodes of equal time; the first state listed for a satellite counts.
std::vector<OrbitEpoch> merged(std::vector<OrbitEpoch> epochs) {
  std::stable_sort(epochs.begin(), epochs.end(),
                   [](const OrbitEpoch& a, const OrbitEpoch& b) { return a.time < b.time; });
  std::vector<OrbitEpoch> result;
  for (OrbitEpoch& epoch : epochs) {
    if (result.empty() || result.back().time != epoch.time) {
      result.push_back(std::move(epoch));
      continue;
    }
    std::vector<PreciseState>& states = result.back().states;
    std::set<SatelliteId> there;
    for (const PreciseState& state : states) there.insert(state.satellite);
    for (const PreciseState& state : epoch.states) {
      if (there.insert(state.satellite).second) states.push_back(state);
    }
  }
  return result;
}

}  // namespace

GpsTime transmission_time(const Ephemeris& ephemeris) {
  if (ephemeris.transmission_time.is_set()) return ephemeris.transmission_time;
  const double lead_s = ephemeris.satellite.system == System::kGps ? 7200.0 : 0.0;
  return ephemeris.toe.plus_seconds(-lead_s);
}

EphemerisSchedule schedule_ephemerides(std::vector<Ephemeris> ephemerides, GpsTime start) {
  for (Ephemeris& e : ephemerides) e.transmission_time = transmission_time(e);
  std::stable_sort(ephemerides.begin(), ephemerides.end(),
                   [](const Ephemeris& a, const Ephemeris& b) {
                     return a.transmission_time < b.transmission_time;
                   });
  EphemerisSchedule schedule;
  using Stream = std::pair<SatelliteId, NavigationMessage>;
  std::set<std::tuple<SatelliteId, NavigationMessage, GpsTime, std::uint16_t>> known;
  std::map<Stream, std::vector<Ephemeris>> at_start;
  std::vector<Ephemeris> later;
  for (const Ephemeris& e : ephemerides) {
    if (!known.emplace(e.satellite, e.message, e.toe, e.issue).second) {
      ++schedule.repeated;
    } else if (e.transmission_time > start) {
      later.push_back(e);
    } else if (is_valid_at(e, start)) {
      at_start[{e.satellite, e.message}].push_back(e);
    } else {
      ++schedule.expired;
    }
  }
  for (auto& [stream, list] : at_start) {
    const std::size_t excess = list.size() > kIssuesInUse ? list.size() - kIssuesInUse : 0;
    schedule.superseded += static_cast<long>(excess);
    for (std::size_t i = excess; i < list.size(); ++i) schedule.items.push_back({start, list[i]});
  }
  for (const Ephemeris& e : later) {
    const bool needed =
        is_valid_at(e, start) && at_start.try_emplace({e.satellite, e.message}).second;
    schedule.items.push_back({needed ? start : e.transmission_time, e});
  }
  std::stable_sort(schedule.items.begin(), schedule.items.end(),
                   [](const ScheduledEphemeris& a, const ScheduledEphemeris& b) {
                     return a.arrival < b.arrival;
                   });
  return schedule;
}

std::vector<ScheduledOrbitEpoch> schedule_orbits(std::vector<OrbitEpoch> epochs, GpsTime start,
                                                 int nodes_ahead) {
  const std::vector<OrbitEpoch> nodes = merged(std::move(epochs));
  // A product of LEO satellites has a node every 30 s, one of GNSS satellites every 900 s. Near and
  // past are therefore determined for each satellite by its own nodes.
  std::map<SatelliteId, std::vector<GpsTime>> times;
  for (const OrbitEpoch& node : nodes) {
    for (const PreciseState& state : node.states) times[state.satellite].push_back(node.time);
  }
  std::map<SatelliteId, std::ptrdiff_t> next;
  std::map<std::pair<GpsTime, GpsTime>, std::vector<PreciseState>> messages;  // arrival, time
  for (const OrbitEpoch& node : nodes) {
    for (const PreciseState& state : node.states) {
      const std::vector<GpsTime>& own = times[state.satellite];
      const std::ptrdiff_t i = next[state.satellite]++;
      if (node_time(own, i + nodes_ahead) <= start) continue;
      const GpsTime arrival = std::max(start, node_time(own, i - nodes_ahead));
      messages[{arrival, node.time}].push_back(state);
    }
  }
  std::vector<ScheduledOrbitEpoch> schedule;
  for (auto& [when, states] : messages) {
    schedule.push_back({when.first, {when.second, std::move(states)}});
  }
  return schedule;
}

}  // namespace leonav
