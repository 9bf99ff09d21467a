#include "core/filter/carrier_ambiguities.h"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "core/filter/state/signal_states.h"

namespace leonav {
namespace {

constexpr double kStartAmbiguitySigma = 100.0;  // m
constexpr double kStartShare = 10.0;            // of the prediction's sigma, added to that
constexpr int kMaxRejectedEpochs = 2;

int count_of(const SignalStates& states) { return static_cast<int>(states.size()); }

std::size_t count_of_ambiguities(const SignalStates& states) {
  return static_cast<std::size_t>(std::count_if(
      states.begin(), states.end(),
      [](const SignalState& state) { return state.kind == SignalState::Kind::kAmbiguity; }));
}

}  // namespace

void remove_ended_arcs(const MeasurementEpoch& epoch, double max_gap_s, StateEstimate* estimate) {
  const SignalStates& states = estimate->state().signal_states;
  for (int i = count_of(states) - 1; i >= 0; --i) {
    const SignalState& ambiguity = states[static_cast<std::size_t>(i)];
    if (ambiguity.kind != SignalState::Kind::kAmbiguity) continue;
    bool ended = ambiguity.rejected >= kMaxRejectedEpochs ||
                 seconds_between(epoch.time, ambiguity.last_used) > max_gap_s;
    for (const Measurement& measurement : epoch.measurements) {
      if (measurement.observable != Observable::kCarrier || measurement.arc == ambiguity.arc)
        continue;
      const SatelliteInView& satellite = epoch.satellites[measurement.satellite_index];
      ended = ended || satellite.satellite == ambiguity.satellite;
    }
    if (ended) estimate->remove_signal_state(i);
  }
}

void make_room_for_new_arcs(const MeasurementEpoch& epoch, StateEstimate* estimate) {
  const SignalStates& states = estimate->state().signal_states;
  boost::container::static_vector<std::uint32_t, kMaxMeasurements> seen;
  std::size_t fresh = 0;
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCarrier || measurement.reason != Reason::kUsed)
      continue;
    seen.push_back(measurement.arc);
    fresh += find_ambiguity(states, measurement.arc) == kNoSignalState ? 1 : 0;
  }
  while (count_of_ambiguities(states) + fresh > kMaxArcs) {
    int longest = kNoSignalState;
    for (int i = 0; i < count_of(states); ++i) {
      const SignalState& ambiguity = states[static_cast<std::size_t>(i)];
      if (ambiguity.kind != SignalState::Kind::kAmbiguity) continue;
      if (std::find(seen.begin(), seen.end(), ambiguity.arc) != seen.end()) continue;
      if (longest == kNoSignalState ||
          ambiguity.last_used < states[static_cast<std::size_t>(longest)].last_used)
        longest = i;
    }
    if (longest == kNoSignalState) return;
    estimate->remove_signal_state(longest);
  }
}

void remove_all(SignalState::Kind kind, StateEstimate* estimate) {
  const SignalStates& states = estimate->state().signal_states;
  for (int i = count_of(states) - 1; i >= 0; --i)
    if (states[static_cast<std::size_t>(i)].kind == kind) estimate->remove_signal_state(i);
}

void remove_ambiguities_of(std::size_t system, StateEstimate* estimate) {
  const SignalStates& states = estimate->state().signal_states;
  for (int i = count_of(states) - 1; i >= 0; --i) {
    const SignalState& state = states[static_cast<std::size_t>(i)];
    if (state.kind == SignalState::Kind::kAmbiguity && index_of(state.satellite.system) == system)
      estimate->remove_signal_state(i);
  }
}

int find_or_add_ambiguity(const Measurement& carrier, SatelliteId satellite,
                          const FilterMeasurement& entry, GpsTime time, StateEstimate* estimate) {
  const SignalStates& states = estimate->state().signal_states;
  const int index = find_ambiguity(states, carrier.arc);
  if (index != kNoSignalState) return estimate->state().first_signal_state() + index;
  if (count_of_ambiguities(states) >= kMaxArcs) return kNoSignalState;
  SignalState ambiguity;
  ambiguity.arc = carrier.arc;
  ambiguity.satellite = satellite;
  ambiguity.value = entry.innovation;
  ambiguity.random_walk = carrier.random_walk;
  ambiguity.started = ambiguity.last_used = time;
  const double predicted =
      std::sqrt(std::max(predicted_variance(entry, estimate->covariance()), 0.0));
  estimate->add_signal_state(ambiguity, kStartAmbiguitySigma + kStartShare * predicted);
  return estimate->state().first_signal_state() + count_of(states) - 1;
}

void inflate_disturbed_states(const MeasurementEpoch& epoch, StateEstimate* estimate) {
  estimate->inflate_position(epoch.position_disturbance_m);
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCarrier || !(measurement.disturbance_m > 0.0))
      continue;
    const int index = find_ambiguity(estimate->state().signal_states, measurement.arc);
    if (index == kNoSignalState) continue;
    estimate->inflate_signal_state(estimate->state().first_signal_state() + index,
                                   measurement.disturbance_m);
  }
}

bool record_carrier(const FilterMeasurement& carrier, GpsTime time, StateEstimate* estimate) {
  estimate->record_use(carrier.signal_state, time, carrier.factor > 0.0);
  return estimate->signal_state_at(carrier.signal_state).rejected >= kMaxRejectedEpochs;
}

}  // namespace leonav
