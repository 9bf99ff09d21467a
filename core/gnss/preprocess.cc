#include "core/gnss/preprocess.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/gnss/code_correction.h"
#include "core/gnss/signal_selection.h"
#include "core/gnss/transmission.h"

namespace leonav {
namespace {

constexpr double kMaxRangeRate = 2.0e4;  // m/s: LEO against a fast vehicle, plus receiver drift

// What is kept beside a SatelliteInView until its measurements are formed.
struct Candidate {
  std::size_t satellite_index = 0;
  std::span<const SignalObservation> observations;
  SelectedSignals signals;
  const Ephemeris* broadcast = nullptr;
};
static_assert(kMaxSatellites >= kMaxObservations, "every satellite of a raw epoch has a place");
using Candidates = boost::container::static_vector<Candidate, kMaxSatellites>;

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

bool has_doppler(const SignalObservation& signal) {
  const double wavelength = wavelength_m(signal.satellite.system, signal.code.band);
  return std::abs(signal.doppler_hz) * wavelength < kMaxRangeRate;  // NaN: not measured
}

// Selects signals and finds the satellite; the reason is left in `view`.
Candidate examine(const DelayContext& context, const SatelliteCatalog& catalog,
                  std::span<const SignalObservation> observations, const Eigen::Vector3d& p_a_e,
                  SatelliteInView* view) {
  const GnssConfig& config = *context.config;
  Candidate candidate;
  candidate.observations = observations;
  view->cn0_dbhz = strongest_cn0(observations);
  const SystemConfig& system = config.systems[index_of(view->satellite.system)];
  if (!system.enabled) {
    view->reason = Reason::kSystemDisabled;
    return candidate;
  }
  candidate.signals = select_signals(observations, system.signals, config.cn0_mask_dbhz);
  if (candidate.signals.first == nullptr) {
    view->reason = reason_without_signal(candidate.signals);
    return candidate;
  }
  view->reason = reason_of(satellite_at_transmission(catalog, context.time,
                                                     candidate.signals.first->pseudorange_m, p_a_e,
                                                     view, &candidate.broadcast));
  if (view->reason != Reason::kUsed) return candidate;
  correct_direction(context, p_a_e, view);
  if (context.has_position && view->elevation < config.elevation_mask) {
    view->reason = Reason::kLowElevation;
  }
  return candidate;
}

bool is_higher(const SatelliteInView& a, const SatelliteInView& b) {
  if (a.elevation != b.elevation) return a.elevation > b.elevation;
  return a.satellite < b.satellite;
}

// Keeps the highest satellites of each system. Equal elevations: the earlier one stays.
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

std::size_t most_measurements(const GnssConfig& config, const Candidate& candidate) {
  const bool one_code = config.code_combination == CodeCombination::kIonosphereFree;
  return (one_code ? 1 : candidate.signals.bands.size()) + 1;  // and a Doppler
}

// Where the measurements would not all fit, the lowest satellites make room.
void apply_capacity(const GnssConfig& config, const Candidates& candidates,
                    MeasurementEpoch* epoch) {
  boost::container::static_vector<const Candidate*, kMaxSatellites> used;
  std::size_t needed = 0;
  for (const Candidate& candidate : candidates) {
    if (epoch->satellites[candidate.satellite_index].reason != Reason::kUsed) continue;
    used.push_back(&candidate);
    needed += most_measurements(config, candidate);
  }
  if (needed <= epoch->measurements.capacity()) return;
  std::sort(used.begin(), used.end(), [&](const Candidate* a, const Candidate* b) {
    return is_higher(epoch->satellites[a->satellite_index], epoch->satellites[b->satellite_index]);
  });
  for (; needed > epoch->measurements.capacity(); used.pop_back()) {
    epoch->satellites[used.back()->satellite_index].reason = Reason::kCapacity;
    needed -= most_measurements(config, *used.back());
  }
}

// apply_capacity() has made room.
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
  if (context.config->code_combination == CodeCombination::kIonosphereFree) {
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

// One Doppler per satellite, since its signals share the receiver's motion and oscillator. The
// ionosphere drifts by some mm/s on a GNSS signal, which is not worth amplifying the noise
// threefold; past a LEO satellite its slant delay changes in minutes, and the pair pays.
void append_doppler(const DelayContext& context, const Candidate& candidate,
                    MeasurementEpoch* epoch) {
  const SatelliteInView& view = epoch->satellites[candidate.satellite_index];
  const SelectedSignals& signals = candidate.signals;
  const bool pair = context.config->code_combination == CodeCombination::kIonosphereFree &&
                    view.satellite.system == System::kLeo && signals.second != nullptr &&
                    has_doppler(*signals.first) && has_doppler(*signals.second);
  if (pair) {
    append(candidate, doppler_measurement(context, *signals.first, signals.second, view), epoch);
    return;
  }
  const SignalObservation* strongest = nullptr;
  for (const SignalObservation* signal : signals.bands) {
    if (!has_doppler(*signal)) continue;
    const bool stronger = strongest == nullptr || signal->cn0_dbhz > strongest->cn0_dbhz ||
                          (std::isnan(strongest->cn0_dbhz) && !std::isnan(signal->cn0_dbhz));
    if (stronger) strongest = signal;
  }
  if (strongest == nullptr) return;
  append(candidate, doppler_measurement(context, *strongest, nullptr, view), epoch);
}

double single_band_value(const DelayContext& context, const Candidate& candidate,
                         const SignalObservation& signal, SatelliteInView view, double* sigma) {
  const Measurement code =
      code_measurement(context, signal, nullptr, candidate.broadcast, 1, &view);
  *sigma = code.sigma;
  return code.value;
}

const SignalObservation* signal_on(const Candidate& candidate, char band) {
  for (const SignalObservation* signal : candidate.signals.bands) {
    if (signal->code.band == band) return signal;
  }
  return nullptr;
}

// The best of the bands that the satellites in use have; bands of a candidate stand best first.
char reference_band(const GnssConfig& config, System system, const Candidates& candidates,
                    const MeasurementEpoch& epoch, char present) {
  const SignalPreference& preference = config.systems[index_of(system)].signals;
  char best = present;
  for (const Candidate& candidate : candidates) {
    const SatelliteInView& view = epoch.satellites[candidate.satellite_index];
    if (view.satellite.system != system || view.reason != Reason::kUsed) continue;
    const char band = candidate.signals.bands.front()->code.band;
    if (best == 0 || band_comes_first(system, preference, band, best)) best = band;
  }
  return best;
}

// `context` without biases: differences are of what the receiver measured.
void estimate_biases(const DelayContext& context, const Candidates& candidates,
                     const MeasurementEpoch& epoch, BandBiases* biases) {
  biases->open(context.time);
  for (const System system : kSystems) {
    const char reference =
        reference_band(*context.config, system, candidates, epoch, biases->reference(system));
    if (reference == 0) continue;
    biases->set_reference(system, reference);
    for (char band = '1'; band <= '9'; ++band) {
      BandDifferences differences;
      for (const Candidate& candidate : candidates) {
        const SatelliteInView& view = epoch.satellites[candidate.satellite_index];
        if (view.satellite.system != system || view.reason != Reason::kUsed) continue;
        const SignalObservation* first = signal_on(candidate, reference);
        const SignalObservation* other = signal_on(candidate, band);
        if (band == reference || first == nullptr || other == nullptr) continue;
        double sigma_first = 0.0, sigma_other = 0.0;
        const double value = single_band_value(context, candidate, *other, view, &sigma_other) -
                             single_band_value(context, candidate, *first, view, &sigma_first);
        if (!std::isfinite(value)) continue;
        differences.values_m.push_back(value);
        differences.sigma_m = std::hypot(sigma_first, sigma_other);
      }
      biases->update(system, band, differences);
    }
  }
}

// Observations of one satellite stand together; the first of another one ends the run.
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

void preprocess(const RawEpoch& raw, const SatelliteCatalog& catalog, const GnssConfig& config,
                const Eigen::Vector3d& approximate_p_e, MeasurementEpoch* epoch,
                BandBiases* biases) {
  epoch->time = raw.time;
  epoch->approximate_p_e = approximate_p_e;
  epoch->satellites.clear();
  epoch->measurements.clear();

  DelayContext context;
  context.config = &config;
  context.klobuchar = &catalog.klobuchar();
  context.time = raw.time;
  context.has_position = !approximate_p_e.isZero();
  if (context.has_position) context.antenna = to_geodetic(approximate_p_e);

  Candidates candidates;
  std::size_t end = 0;
  for (std::size_t begin = 0; begin < raw.observations.size(); begin = end) {
    end = end_of_run(raw, begin);
    const SatelliteId id = raw.observations[begin].satellite;
    if (index_of(id.system) >= kSystemCount || is_listed(*epoch, id)) continue;
    SatelliteInView view;
    view.satellite = id;
    candidates.push_back(examine(context, catalog, {raw.observations.data() + begin, end - begin},
                                 approximate_p_e, &view));
    candidates.back().satellite_index = epoch->satellites.size();
    epoch->satellites.push_back(view);
  }
  if (context.has_position) apply_caps(config, epoch);
  apply_capacity(config, candidates, epoch);
  BandBiases of_this_epoch;
  if (biases == nullptr) biases = &of_this_epoch;
  estimate_biases(context, candidates, *epoch, biases);
  context.biases = biases;
  for (const Candidate& candidate : candidates) {
    if (epoch->satellites[candidate.satellite_index].reason != Reason::kUsed) continue;
    append_code(context, candidate, epoch);
    append_doppler(context, candidate, epoch);
  }
}

}  // namespace leonav
