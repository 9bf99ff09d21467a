#include "core/filter/carrier_ambiguities.h"

#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>

#include "core/filter/state/ambiguities.h"

namespace leonav {
namespace {

constexpr double kStartAmbiguitySigma = 100.0;  // m
constexpr double kStartShare = 10.0;            // of the prediction's sigma, added to that
constexpr int kMaxRejectedEpochs = 2;

int count_of(const Ambiguities& ambiguities) { return static_cast<int>(ambiguities.size()); }

}  // namespace

void remove_ended_arcs(const MeasurementEpoch& epoch, double max_gap_s, const ArcJoiner& joiner,
                       StateEstimate* estimate) {
  const Ambiguities& ambiguities = estimate->state().ambiguities;
  for (int i = count_of(ambiguities) - 1; i >= 0; --i) {
    const Ambiguity& ambiguity = ambiguities[static_cast<std::size_t>(i)];
    bool ended = ambiguity.rejected >= kMaxRejectedEpochs ||
                 seconds_between(epoch.time, ambiguity.last_used) > max_gap_s;
    const bool kept = joiner.keeps(ambiguity.arc);
    for (const Measurement& measurement : epoch.measurements) {
      if (kept || measurement.observable != Observable::kCarrier ||
          measurement.arc == ambiguity.arc)
        continue;
      const SatelliteInView& satellite = epoch.satellites[measurement.satellite_index];
      ended = ended || satellite.satellite == ambiguity.satellite;
    }
    if (ended) estimate->remove_ambiguity(i);
  }
}

void make_room_for_new_arcs(const MeasurementEpoch& epoch, StateEstimate* estimate) {
  const Ambiguities& ambiguities = estimate->state().ambiguities;
  boost::container::static_vector<std::uint32_t, kMaxMeasurements> seen;
  std::size_t fresh = 0;
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCarrier || measurement.reason != Reason::kUsed)
      continue;
    seen.push_back(measurement.arc);
    fresh += find_ambiguity(ambiguities, measurement.arc) == kNoAmbiguity ? 1 : 0;
  }
  while (ambiguities.size() + fresh > ambiguities.capacity()) {
    int longest = kNoAmbiguity;
    for (int i = 0; i < count_of(ambiguities); ++i) {
      const Ambiguity& ambiguity = ambiguities[static_cast<std::size_t>(i)];
      if (std::find(seen.begin(), seen.end(), ambiguity.arc) != seen.end()) continue;
      if (longest == kNoAmbiguity ||
          ambiguity.last_used < ambiguities[static_cast<std::size_t>(longest)].last_used)
        longest = i;
    }
    if (longest == kNoAmbiguity) return;
    estimate->remove_ambiguity(longest);
  }
}

void remove_all_ambiguities(StateEstimate* estimate) {
  while (!estimate->state().ambiguities.empty())
    estimate->remove_ambiguity(count_of(estimate->state().ambiguities) - 1);
}

void remove_ambiguities_of(std::size_t system, StateEstimate* estimate) {
  const Ambiguities& ambiguities = estimate->state().ambiguities;
  for (int i = count_of(ambiguities) - 1; i >= 0; --i)
    if (index_of(ambiguities[static_cast<std::size_t>(i)].satellite.system) == system)
      estimate->remove_ambiguity(i);
}

int find_or_add_ambiguity(const Measurement& carrier, SatelliteId satellite,
                          const FilterMeasurement& entry, GpsTime time, StateEstimate* estimate) {
  const Ambiguities& ambiguities = estimate->state().ambiguities;
  const int index = find_ambiguity(ambiguities, carrier.arc);
  if (index != kNoAmbiguity) return estimate->state().first_ambiguity() + index;
  if (ambiguities.size() == ambiguities.capacity()) return kNoAmbiguity;
  Ambiguity ambiguity;
  ambiguity.arc = carrier.arc;
  ambiguity.satellite = satellite;
  ambiguity.value_m = entry.innovation;
  ambiguity.random_walk = carrier.random_walk;
  ambiguity.started = ambiguity.last_used = time;
  const double predicted =
      std::sqrt(std::max(predicted_variance(entry, estimate->covariance()), 0.0));
  estimate->add_ambiguity(ambiguity, kStartAmbiguitySigma + kStartShare * predicted);
  return estimate->state().first_ambiguity() + count_of(ambiguities) - 1;
}

void inflate_disturbed_states(const MeasurementEpoch& epoch, StateEstimate* estimate) {
  estimate->inflate_position(epoch.position_disturbance_m);
  for (const Measurement& measurement : epoch.measurements) {
    if (measurement.observable != Observable::kCarrier || !(measurement.disturbance_m > 0.0))
      continue;
    const int index = find_ambiguity(estimate->state().ambiguities, measurement.arc);
    if (index == kNoAmbiguity) continue;
    estimate->inflate_ambiguity(estimate->state().first_ambiguity() + index,
                                measurement.disturbance_m);
  }
}

bool record_carrier(const FilterMeasurement& carrier, GpsTime time, StateEstimate* estimate) {
  estimate->record_carrier(carrier.ambiguity, time, carrier.factor > 0.0);
  return estimate->ambiguity_of_state(carrier.ambiguity).rejected >= kMaxRejectedEpochs;
}

}  // namespace leonav
