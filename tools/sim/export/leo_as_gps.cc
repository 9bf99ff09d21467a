#include "tools/sim/export/leo_as_gps.h"

#include <limits>
#include <set>

#include "core/gnss/measurement/look_angles.h"

namespace leonav::sim {
namespace {

constexpr std::uint16_t kGpsNames = 32;  // that programs support

}  // namespace

bool LeoAsGps::rises(const TrueSatellite& satellite, double last_s) const {
  const Eigen::Vector3d p_e = to_ecef(scenario_.route.origin);
  for (double t = 0.0; t <= last_s; t += 10.0) {
    const Eigen::Vector3d p_s_e = to_earth(satellite.orbit.at(t).p_i, t);
    if (look_angles(p_s_e, p_e).elevation > scenario_.receiver.elevation_mask) return true;
  }
  return false;
}

LeoAsGps::LeoAsGps(const Scenario& scenario, const TrueSky& sky) : scenario_(scenario), sky_(sky) {
  std::set<SatelliteId> taken;
  const double start_s = kStartEpochs * scenario.receiver.interval_s;
  for (const TrueSatellite& satellite : sky.satellites) {
    const SatelliteId id = satellite.id;
    if (id.system == System::kGps && id.number <= kGpsNames && rises(satellite, start_s)) {
      taken.insert(names_[id] = id);
    }
  }
  SatelliteId name{System::kGps, 1};
  for (const TrueSatellite& satellite : sky.satellites) {
    while (taken.count(name) != 0) ++name.number;
    if (name.number > kGpsNames) break;
    if (satellite.id.system != System::kLeo || !rises(satellite, scenario.duration_s)) continue;
    taken.insert(names_[satellite.id] = name);
  }
}

RawEpoch LeoAsGps::epoch(const RawEpoch& epoch) {
  const System wanted = epochs_++ < kStartEpochs ? System::kGps : System::kLeo;
  // The observations are sorted by the new names.
  std::map<std::pair<SatelliteId, SignalCode>, SignalObservation> named;
  for (SignalObservation observation : epoch.observations) {
    const auto name = names_.find(observation.satellite);
    if (name == names_.end() || observation.satellite.system != wanted) continue;
    observation.satellite = name->second;
    named[{observation.satellite, observation.code}] = observation;
  }
  RawEpoch result;
  result.time = epoch.time;
  for (const auto& [key, observation] : named) result.observations.push_back(observation);
  return result;
}

Products LeoAsGps::products() const {
  const ConstellationConfig& leo = scenario_.constellations[index_of(System::kLeo)];
  static constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto nodes = [this](double interval_s, bool clock_only) {
    std::vector<OrbitEpoch> epochs;
    for (int i = -12; i * interval_s <= scenario_.duration_s + 12.0 * interval_s; ++i) {
      const double t = i * interval_s;
      OrbitEpoch epoch{scenario_.start.plus_seconds(t), {}};
      for (const TrueSatellite& satellite : sky_.satellites) {
        const auto name = names_.find(satellite.id);
        if (name == names_.end()) continue;
        PreciseState state;
        state.satellite = name->second;
        state.time = epoch.time;
        state.p_e = to_earth(satellite.orbit.at(t).p_i, t);
        if (clock_only) state.p_e.setConstant(kNaN);
        state.clock_s = satellite.clock.at(t).offset_s;
        epoch.states.push_back(state);
      }
      epochs.push_back(std::move(epoch));
    }
    return epochs;
  };
  return {nodes(leo.node_interval_s, false), nodes(leo.clock_interval_s, true)};
}

std::vector<Ephemeris> LeoAsGps::elements(const BroadcastMessages& messages) const {
  constexpr double kInterval = 600.0;
  std::vector<Ephemeris> elements;
  for (const Ephemeris& e : messages.ephemerides) {
    if (names_.count(e.satellite) != 0) elements.push_back(e);
  }
  for (const TrueSatellite& satellite : sky_.satellites) {
    const auto name = names_.find(satellite.id);
    if (name == names_.end() || satellite.id.system != System::kLeo) continue;
    for (double toe = 0.0; toe <= scenario_.duration_s + 0.5 * kInterval; toe += kInterval) {
      const IssueRequest request{name->second, toe, kInterval};
      elements.push_back(fit_issue(scenario_, satellite, request).elements);
      elements.back().transmission_time = elements.back().toe;
    }
  }
  return elements;
}

std::vector<AntennaPattern> LeoAsGps::antennas(std::span<const AntennaPattern> antennas) const {
  std::vector<AntennaPattern> named;
  for (AntennaPattern pattern : antennas) {
    const auto name = names_.find(pattern.satellite);
    if (!pattern.is_receiver && name == names_.end()) continue;
    if (!pattern.is_receiver) pattern.satellite = name->second;
    named.push_back(pattern);
  }
  return named;
}

}  // namespace leonav::sim
