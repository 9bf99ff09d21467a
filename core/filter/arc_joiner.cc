#include "core/filter/arc_joiner.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/filter/state/ambiguities.h"

namespace leonav {
namespace {

// Sharpness (CycleSearch) from which on a pair of arcs shows whether they differ by whole cycles.
constexpr double kSharp = 4.0;

// Returns whether a satellite's signal is as strong as it has been. Without a code, or without a
// C/N0, that is not known.
bool is_direct(const MeasurementEpoch& epoch, std::size_t satellite, const LearnedErrors& errors,
               bool standing) {
  const SatelliteInView& in_view = epoch.satellites[satellite];
  if (!(in_view.cn0_dbhz > 0.0)) return false;
  const auto code = std::find_if(epoch.measurements.begin(), epoch.measurements.end(),
                                 [&](const Measurement& measurement) {
                                   return measurement.observable == Observable::kCode &&
                                          measurement.satellite_index == satellite;
                                 });
  return code != epoch.measurements.end() && errors.class_of(*code, in_view, standing).loss == 0;
}

}  // namespace

ArcJoiner::Arc* ArcJoiner::find(std::uint32_t arc) {
  const auto found =
      std::find_if(arcs_.begin(), arcs_.end(), [arc](const Arc& of) { return of.arc == arc; });
  return found == arcs_.end() ? nullptr : &*found;
}

const ArcJoiner::Arc* ArcJoiner::find(std::uint32_t arc) const {
  return const_cast<ArcJoiner*>(this)->find(arc);
}

bool ArcJoiner::keeps(std::uint32_t arc) const {
  if (!config_.join_arcs) return false;
  const Arc* found = find(arc);
  return found != nullptr && found->direct && !found->cycles.half_cycle_unresolved;
}

int ArcJoiner::join(StateEstimate* estimate) {
  if (!config_.join_arcs) return 0;
  int joined = 0;
  while (join_one(estimate)) ++joined;  // each makes the position, and so the others, more certain
  return joined;
}

bool ArcJoiner::join_one(StateEstimate* estimate) {
  const Ambiguities& ambiguities = estimate->state().ambiguities;
  for (Arc& now : arcs_) {
    if (!now.always_direct || now.cycles.half_cycle_unresolved) continue;
    const int to = find_ambiguity(ambiguities, now.arc);
    if (to == kNoAmbiguity || ambiguities[static_cast<std::size_t>(to)].rejected > 0) continue;
    for (const Arc& old : arcs_) {
      if (old.satellite != now.satellite || !(old.last < now.started) || !keeps(old.arc)) continue;
      const int from = find_ambiguity(ambiguities, old.arc);
      if (from == kNoAmbiguity || ambiguities[static_cast<std::size_t>(from)].rejected > 0)
        continue;
      const std::optional<CycleSearch> between = cycles_between(old, now, *estimate);
      if (!between) continue;
      if (!now.share_before && between->sharpness > kSharp) {
        now.share_before = whole_cycles_.share();
        whole_cycles_.learn(between->likelihood_ratio);
      }
      if (!between->found) continue;
      // What this pair of arcs has taught of the share must not count for itself once more.
      const double whole = WholeCycles::probability(
          between->likelihood_ratio, now.share_before.value_or(whole_cycles_.share()));
      const double wrong = 1.0 - whole * (1.0 - between->wrong_probability);
      if (!(wrong < config_.wrong_join_probability)) continue;
      estimate->join_ambiguities(from, to,
                                 between->length_m + now.cycles.repaired_measurement_m() -
                                     old.cycles.repaired_measurement_m(),
                                 std::hypot(old.sigma_m, now.sigma_m));
      estimate->record_join(from, to, wrong, between->alternative_m);
      estimate->remove_ambiguity(from);
      return true;
    }
  }
  return false;
}

std::optional<CycleSearch> ArcJoiner::cycles_between(const Arc& old, const Arc& now,
                                                     const StateEstimate& estimate) const {
  if (old.code != now.code || old.second_code != now.second_code ||
      old.cycles.wavelength_m != now.cycles.wavelength_m || old.source != now.source ||
      old.orbit_issue != now.orbit_issue || old.antenna_issue != now.antenna_issue ||
      (!now.cycles.is_pair() && old.ionosphere_issue != now.ionosphere_issue))
    return std::nullopt;
  const FilterState& state = estimate.state();
  const int first = state.first_ambiguity();
  const int from = find_ambiguity(state.ambiguities, old.arc);
  const int to = find_ambiguity(state.ambiguities, now.arc);
  const EkfCovariance& P = estimate.covariance();
  const double variance =
      P(first + from, first + from) + P(first + to, first + to) - 2.0 * P(first + from, first + to);
  CycleEquations equations;
  equations.wavelength_m = now.cycles.wavelength_m;
  equations.gamma = now.cycles.gamma;
  equations.difference_m = state.ambiguities[static_cast<std::size_t>(to)].value_m -
                           state.ambiguities[static_cast<std::size_t>(from)].value_m -
                           now.cycles.repaired_measurement_m() +
                           old.cycles.repaired_measurement_m();
  equations.difference_sigma_m =
      std::sqrt(std::max(variance, 0.0) + square(old.sigma_m) + square(now.sigma_m));
  if (now.cycles.is_pair()) {
    const GeometryFreeTrend::Innovation change = old.geometry_free.innovation(
        now.first_geometry_free_m, seconds_between(now.started, old.last),
        now.cycles.geometry_free_noise);
    equations.geometry_free_m = change.value_m - now.cycles.repaired_geometry_free_m() +
                                old.cycles.repaired_geometry_free_m();
    // The errors of reflections nearby last longer than the trend takes them to do; both ends have
    // them, as large as the carriers' noise.
    const double to_geometry_free =
        std::sqrt(2.0) / std::hypot(now.cycles.gamma[0], now.cycles.gamma[1]);
    equations.geometry_free_sigma_m =
        std::hypot(change.sigma_m, to_geometry_free * old.sigma_m, to_geometry_free * now.sigma_m);
  }
  return search_cycles(equations);
}

void ArcJoiner::take(const Measurement& carrier, const SatelliteInView& satellite, GpsTime time,
                     bool direct) {
  const CarrierCycles& cycles = carrier.cycles;
  Arc* arc = find(carrier.arc);
  if (arc == nullptr) {
    if (arcs_.size() == arcs_.capacity()) return;
    arcs_.emplace_back();
    arc = &arcs_.back();
    arc->arc = carrier.arc;
    arc->satellite = satellite.satellite;
    arc->code = carrier.code;
    arc->second_code = carrier.second_code;
    arc->started = time;
    arc->always_direct = true;
    arc->first_geometry_free_m = cycles.geometry_free_m;
    arc->geometry_free.start(cycles.geometry_free_m, 0.0, cycles.geometry_free_noise, false);
  } else {
    arc->geometry_free.update(cycles.geometry_free_m, seconds_between(time, arc->last),
                              cycles.geometry_free_noise);
  }
  arc->last = time;
  arc->cycles = cycles;
  arc->sigma_m = carrier.sigma;
  arc->source = satellite.source;
  arc->orbit_issue = satellite.orbit_issue;
  arc->antenna_issue = satellite.antenna_issue;
  arc->ionosphere_issue = satellite.ionosphere_issue;
  arc->direct = direct;
  arc->always_direct = arc->always_direct && direct;
}

void ArcJoiner::observe(const MeasurementEpoch& epoch, const FilterMeasurements& measurements,
                        const LearnedErrors& errors, bool standing, const FilterState& state) {
  if (!config_.join_arcs) return;
  arcs_.erase(std::remove_if(arcs_.begin(), arcs_.end(),
                             [&state](const Arc& arc) {
                               return find_ambiguity(state.ambiguities, arc.arc) == kNoAmbiguity;
                             }),
              arcs_.end());
  for (const FilterMeasurement& used : measurements) {
    if (used.ambiguity < 0 || !(used.factor > 0.0)) continue;
    const Measurement& carrier = epoch.measurements[used.index];
    const std::size_t satellite = carrier.satellite_index;
    take(carrier, epoch.satellites[satellite], epoch.time,
         is_direct(epoch, satellite, errors, standing));
  }
}

}  // namespace leonav
