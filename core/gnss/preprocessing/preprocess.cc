#include "core/gnss/preprocessing/preprocess.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/gnss/measurement/transmission_state.h"
#include "core/gnss/preprocessing/internal/candidate.h"
#include "core/gnss/preprocessing/internal/carrier_correction.h"
#include "core/gnss/preprocessing/internal/carrier_selection.h"
#include "core/gnss/preprocessing/internal/code_bias_estimation.h"
#include "core/gnss/preprocessing/internal/code_correction.h"
#include "core/gnss/preprocessing/internal/path_correction.h"
#include "core/gnss/preprocessing/signal_selection.h"

namespace leonav {
namespace {

constexpr double kMaxRangeRate = 2.0e4;  // m/s: LEO against a fast vehicle, plus receiver drift

Reason reason_of(LookupStatus status) {
  switch (status) {
    case LookupStatus::kOk:
      return Reason::kUsed;
    case LookupStatus::kNoEphemeris:
      return Reason::kNoEphemeris;
    case LookupStatus::kTooOld:
      return Reason::kEphemerisTooOld;
    case LookupStatus::kUnhealthy:
      return Reason::kUnhealthy;
  }
  return Reason::kNoEphemeris;
}

Reason reason_without_signal(const SelectedSignals& signals) {
  if (!signals.any_pseudorange) return Reason::kNoUsableSignal;
  return signals.any_plausible ? Reason::kLowCn0 : Reason::kImplausible;
}

double strongest_cn0(std::span<const SignalObservation> observations) {
  double strongest = 0.0;
  for (const SignalObservation& signal : observations) {
    if (signal.cn0_dbhz > strongest) strongest = signal.cn0_dbhz;
  }
  return strongest;
}

// Receivers write exactly zero where they measured no Doppler.
bool has_doppler(const DelayContext& context, const SignalObservation& signal) {
  const double wavelength =
      context.config->bands.wavelength_m(signal.satellite.system, signal.code.band);
  return signal.doppler_hz != 0.0 &&
         std::abs(signal.doppler_hz) * wavelength < kMaxRangeRate;  // NaN: not measured
}

// Selects the signals and computes the satellite's state; the reason is set in `view`.
Candidate examine(const DelayContext& context, const EphemerisStore& ephemeris_store,
                  std::span<const SignalObservation> observations, const Eigen::Vector3d& p_a_e,
                  std::span<const SatelliteId> faulty, SatelliteInView* view) {
  const GnssConfig& config = *context.config;
  Candidate candidate;
  candidate.observations = observations;
  view->cn0_dbhz = strongest_cn0(observations);
  const SystemConfig& system = config.systems[index_of(view->satellite.system)];
  if (!system.enabled) {
    view->reason = Reason::kSystemDisabled;
    return candidate;
  }
  candidate.signals =
      select_signals(observations, system.signals, config.cn0_mask_dbhz, config.bands);
  if (candidate.signals.first == nullptr) {
    view->reason = reason_without_signal(candidate.signals);
    return candidate;
  }
  view->reason = reason_of(satellite_at_transmission(ephemeris_store, context.time,
                                                     candidate.signals.first->pseudorange_m, p_a_e,
                                                     view, &candidate.broadcast));
  if (view->reason != Reason::kUsed) return candidate;
  set_look_angles_and_troposphere(context, p_a_e, view);
  if (std::find(faulty.begin(), faulty.end(), view->satellite) != faulty.end())
    view->reason = Reason::kFaulty;
  if (context.has_position && view->elevation < config.elevation_mask) {
    view->reason = Reason::kLowElevation;
  }
  return candidate;
}

bool is_higher(const SatelliteInView& a, const SatelliteInView& b) {
  if (a.elevation != b.elevation) return a.elevation > b.elevation;
  return a.satellite < b.satellite;
}

// Keeps the highest satellites of each system; of equal elevations the earlier one is kept.
void apply_caps(const GnssConfig& config, MeasurementEpoch* epoch) {
  for (const System system : kSystems) {
    const int cap = config.systems[index_of(system)].max_satellites;
    if (cap <= 0) continue;
    boost::container::static_vector<SatelliteInView*, kMaxSatellites> used;
    for (SatelliteInView& view : epoch->satellites) {
      if (view.satellite.system == system && view.reason == Reason::kUsed) used.push_back(&view);
    }
    std::sort(used.begin(), used.end(),
              [](const SatelliteInView* a, const SatelliteInView* b) { return is_higher(*a, *b); });
    for (std::size_t i = static_cast<std::size_t>(cap); i < used.size(); ++i) {
      used[i]->reason = Reason::kSatelliteCap;
    }
  }
}

std::size_t most_measurements(const GnssConfig& config, const Candidate& candidate, bool carriers) {
  const bool one_code = config.code_combination != CodeCombination::kSingleFrequency;
  return (one_code ? 1 : candidate.signals.bands.size()) +
         (carriers ? 2 : 1);  // and a carrier, a Doppler
}

// Excludes the lowest satellites where the measurements would exceed the capacity.
void apply_capacity(const GnssConfig& config, const Candidates& candidates, bool carriers,
                    MeasurementEpoch* epoch) {
  boost::container::static_vector<const Candidate*, kMaxSatellites> used;
  std::size_t needed = 0;
  for (const Candidate& candidate : candidates) {
    if (epoch->satellites[candidate.satellite_index].reason != Reason::kUsed) continue;
    used.push_back(&candidate);
    needed += most_measurements(config, candidate, carriers);
  }
  if (needed <= epoch->measurements.capacity()) return;
  std::sort(used.begin(), used.end(), [&](const Candidate* a, const Candidate* b) {
    return is_higher(epoch->satellites[a->satellite_index], epoch->satellites[b->satellite_index]);
  });
  for (; needed > epoch->measurements.capacity(); used.pop_back()) {
    epoch->satellites[used.back()->satellite_index].reason = Reason::kCapacity;
    needed -= most_measurements(config, *used.back(), carriers);
  }
}

// Appends one measurement; apply_capacity() has made sure that it fits.
void append(const Candidate& candidate, Measurement measurement, MeasurementEpoch* epoch) {
  if (!std::isfinite(measurement.value) || !(measurement.sigma > 0.0) ||
      !std::isfinite(measurement.sigma)) {
    return;
  }
  measurement.satellite_index = static_cast<std::uint16_t>(candidate.satellite_index);
  epoch->measurements.push_back(measurement);
}

void append_code(const DelayContext& context, const Candidate& candidate, MeasurementEpoch* epoch) {
  SatelliteInView* view = &epoch->satellites[candidate.satellite_index];
  const SelectedSignals& signals = candidate.signals;
  if (signals.second != nullptr)
    view->code_variances = code_variances(context, {signals.bands.data(), signals.bands.size()},
                                          *signals.second, *view);
  if (context.config->code_combination != CodeCombination::kSingleFrequency) {
    append(candidate,
           code_measurement(context, *signals.first, signals.second, candidate.broadcast, 1, view),
           epoch);
    return;
  }
  const int count = static_cast<int>(signals.bands.size());
  for (const SignalObservation* signal : signals.bands) {
    append(candidate, code_measurement(context, *signal, nullptr, candidate.broadcast, count, view),
           epoch);
  }
}

// Each satellite gives one Doppler, since its signals share the receiver's motion and oscillator.
// On a GNSS signal the ionosphere drifts by some mm/s, which does not justify three times the
// noise. Past a LEO satellite the slant delay changes within minutes, and the ionosphere-free pair
// is better.
void append_doppler(const DelayContext& context, const Candidate& candidate,
                    MeasurementEpoch* epoch) {
  const SatelliteInView& view = epoch->satellites[candidate.satellite_index];
  const SelectedSignals& signals = candidate.signals;
  const bool pair = view.satellite.system == System::kLeo && signals.second != nullptr &&
                    has_doppler(context, *signals.first) && has_doppler(context, *signals.second);
  if (pair) {
    append(candidate, doppler_measurement(context, *signals.first, signals.second, view), epoch);
    return;
  }
  const SignalObservation* strongest = nullptr;
  for (const SignalObservation* signal : signals.bands) {
    if (!has_doppler(context, *signal)) continue;
    const bool stronger = strongest == nullptr || signal->cn0_dbhz > strongest->cn0_dbhz ||
                          (std::isnan(strongest->cn0_dbhz) && !std::isnan(signal->cn0_dbhz));
    if (stronger) strongest = signal;
  }
  if (strongest == nullptr) return;
  append(candidate, doppler_measurement(context, *strongest, nullptr, view), epoch);
}

// Returns the step of the carrier by a change of broadcast elements since it was last measured.
double orbit_step(const DelayContext& context, const EphemerisStore& ephemeris_store,
                  const Candidate& candidate, const SatelliteInView& view, std::uint32_t before) {
  if (before == 0 || before == view.orbit_issue) return 0.0;
  const Ephemeris* from = ephemeris_store.ephemeris_of_issue(view.satellite, before);
  const Ephemeris* to = ephemeris_store.ephemeris_of_issue(view.satellite, view.orbit_issue);
  if (from == nullptr || to == nullptr) return kNotMeasured;
  const double flight_s = candidate.signals.first->pseudorange_m / kSpeedOfLight;
  return orbit_step_m(*from, *to, context.time.plus_seconds(-flight_s), to_ecef(context.antenna));
}

void append_carriers(const DelayContext& context, const EphemerisStore& ephemeris_store,
                     const Candidates& candidates, CarrierPreprocessor* carriers,
                     MeasurementEpoch* epoch) {
  boost::container::static_vector<std::pair<const Candidate*, CarrierChoice>, kMaxSatellites>
      tracked_carriers;
  carriers->begin(context.time);
  for (const Candidate& candidate : candidates) {
    SatelliteInView& view = epoch->satellites[candidate.satellite_index];
    if (view.reason != Reason::kUsed) continue;
    view.wind_up_cycles = wind_up_cycles(context, view, carriers->last_wind_up(view.satellite));
    carriers->set_wind_up(view.satellite, view.wind_up_cycles);
    const CarrierChoice choice =
        choose_carriers(candidate.observations, candidate.signals, context.config->cn0_mask_dbhz,
                        carriers->tracked_pair(view.satellite));
    if (choice.first == nullptr) continue;
    view.orbit_step_m =
        orbit_step(context, ephemeris_store, candidate, view, carriers->last_issue(view.satellite));
    carriers->add_carrier(choice, view.elevation);
    tracked_carriers.push_back({&candidate, choice});
  }
  const ArcEpoch& arcs = carriers->update_arcs();
  for (std::size_t i = 0; i < tracked_carriers.size(); ++i) {
    const auto& [candidate, choice] = tracked_carriers[i];
    SatelliteInView& view = epoch->satellites[candidate->satellite_index];
    append(*candidate,
           carrier_measurement(context, *choice.first, choice.second, arcs.satellites[i], &view),
           epoch);
  }
}

// Returns the end of a run: observations of one satellite are contiguous, and another satellite
// ends the run.
std::size_t end_of_run(const RawEpoch& raw, std::size_t begin) {
  std::size_t end = begin + 1;
  while (end < raw.observations.size() &&
         raw.observations[end].satellite == raw.observations[begin].satellite) {
    ++end;
  }
  return end;
}

bool is_listed(const MeasurementEpoch& epoch, SatelliteId id) {
  return std::any_of(epoch.satellites.begin(), epoch.satellites.end(),
                     [id](const SatelliteInView& view) { return view.satellite == id; });
}

}  // namespace

void preprocess(const RawEpoch& raw, const EphemerisStore& ephemeris_store,
                const GnssConfig& config, const Eigen::Vector3d& approximate_p_e,
                MeasurementEpoch* epoch, const PreprocessAids& aids) {
  epoch->time = raw.time;
  epoch->approximate_p_e = approximate_p_e;
  epoch->satellites.clear();
  epoch->measurements.clear();
  epoch->position_disturbance_m = epoch->ionosphere_step_m = 0.0;

  DelayContext context =
      delay_context(config, ephemeris_store.klobuchar(), raw.time, approximate_p_e);
  context.klobuchar_issue = ephemeris_store.klobuchar_issue();
  context.antennas = aids.antennas;
  context.signal_biases = aids.signal_biases;
  if (aids.C_er != nullptr) context.C_er = *aids.C_er;

  Candidates candidates;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < raw.observations.size(); begin = end) {
    end = end_of_run(raw, begin);
    const SatelliteId id = raw.observations[begin].satellite;
    if (index_of(id.system) >= kSystemCount || is_listed(*epoch, id)) continue;
    SatelliteInView view;
    view.satellite = id;
    candidates.push_back(examine(context, ephemeris_store,
                                 {raw.observations.data() + begin, end - begin}, approximate_p_e,
                                 aids.faulty, &view));
    candidates.back().satellite_index = epoch->satellites.size();
    epoch->satellites.push_back(view);
  }
  if (aids.caps && context.has_position) apply_caps(config, epoch);
  apply_capacity(config, candidates, aids.carriers != nullptr, epoch);
  ReceiverCodeBiases of_this_epoch;
  ReceiverCodeBiases* biases = aids.biases != nullptr ? aids.biases : &of_this_epoch;
  estimate_code_biases(context, candidates, *epoch, biases);
  context.biases = biases;
  for (const Candidate& candidate : candidates) {
    if (epoch->satellites[candidate.satellite_index].reason != Reason::kUsed) continue;
    append_code(context, candidate, epoch);
    append_doppler(context, candidate, epoch);
  }
  if (aids.carriers != nullptr && context.has_position)
    append_carriers(context, ephemeris_store, candidates, aids.carriers, epoch);
}

}  // namespace leonav
