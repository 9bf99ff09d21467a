#include "core/gnss/preprocessing/internal/code_bias_estimation.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/gnss/measurement/weighting.h"

namespace leonav {
namespace {

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

// Returns the best of the bands of the satellites in use; a candidate's bands are sorted best
// first.
char reference_band(const GnssConfig& config, System system, const Candidates& candidates,
                    const MeasurementEpoch& epoch, char present) {
  const SignalPreference& preference = config.systems[index_of(system)].signals;
  char best = present;
  for (const Candidate& candidate : candidates) {
    const SatelliteInView& view = epoch.satellites[candidate.satellite_index];
    if (view.satellite.system != system || view.reason != Reason::kUsed) continue;
    const char band = candidate.signals.bands.front()->code.band;
    if (best == 0 || band_comes_first(system, preference, band, best, config.bands)) best = band;
  }
  return best;
}

// Returns the band that most satellites combine with the reference band; of equals the earlier one.
char most_frequent_partner(System system, char reference, const Candidates& candidates,
                           const MeasurementEpoch& epoch) {
  std::array<int, 10> counts{};
  for (const Candidate& candidate : candidates) {
    const SatelliteInView& view = epoch.satellites[candidate.satellite_index];
    const SelectedSignals& signals = candidate.signals;
    if (view.satellite.system != system || view.reason != Reason::kUsed) continue;
    if (signals.second == nullptr || signals.first->code.band != reference) continue;
    ++counts[static_cast<std::size_t>(signals.second->code.band - '0')];
  }
  const auto most = std::max_element(counts.begin(), counts.end());
  return *most > 0 ? static_cast<char>('0' + (most - counts.begin())) : '\0';
}

}  // namespace

void estimate_code_biases(const DelayContext& context, const Candidates& candidates,
                          const MeasurementEpoch& epoch, ReceiverCodeBiases* biases) {
  const bool pairs = context.config->code_combination != CodeCombination::kSingleFrequency;
  const BandPlan& bands = context.config->bands;
  biases->open(context.time);
  for (const System system : kSystems) {
    const char reference =
        reference_band(*context.config, system, candidates, epoch, biases->reference(system));
    if (reference == 0) continue;
    biases->set_reference(system, reference);
    if (pairs && biases->partner(system) == 0) {
      const char partner = most_frequent_partner(system, reference, candidates, epoch);
      if (partner != 0) {
        const double f1 = bands.frequency_hz(system, reference),
                     f2 = bands.frequency_hz(system, partner);
        biases->set_partner(system, partner, ionosphere_free(f1, f2).gamma2);
      }
    }
    for (char band = '1'; band <= '9'; ++band) {
      InterBandDifferences differences;
      const double band_factor = ionosphere_factor(bands.frequency_hz(system, band)) -
                                 ionosphere_factor(bands.frequency_hz(system, reference));
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
        differences.ionosphere_mappings.push_back(ionosphere_slant(view.elevation) * band_factor);
        differences.sigma_m = std::hypot(sigma_first, sigma_other);
      }
      biases->update(system, band, differences);
    }
  }
}

}  // namespace leonav
