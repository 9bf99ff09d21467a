#include "core/gnss/preprocessing/signal_selection.h"

#include <algorithm>
#include <cmath>

#include "core/gnss/measurement/weighting.h"

namespace leonav {
namespace {

constexpr double kMinPseudorange = 2.0e5;  // m
// A receiver clock of -30 ms subtracts 9000 km, more than a LEO satellite's distance.
constexpr double kMinPseudorangeLeo = -1.0e7;
constexpr double kMaxPseudorange = 6.0e7;

// Returns the index in a list, or the list's length if absent: smaller is better.
template <typename List>
int preference_rank(const List& list, char wanted) {
  return static_cast<int>(std::find(list.begin(), list.end(), wanted) - list.begin());
}

int band_rank(const SignalPreference& preference, char band) {
  if (band == preference.first_band) return 0;
  return 1 + preference_rank(preference.second_bands, band);
}

// Strict order of the signals of one satellite: better first.
bool is_better(const SignalPreference& preference, const BandPlan& bands,
               const SignalObservation& a, const SignalObservation& b) {
  return signal_comes_first(a.satellite.system, preference, a.code, b.code, bands);
}

bool is_useful_pair(const BandPlan& bands, const SignalObservation& a, const SignalObservation& b) {
  const double fa = bands.frequency_hz(a.satellite.system, a.code.band);
  const double fb = bands.frequency_hz(b.satellite.system, b.code.band);
  return fa != fb && combined_sigma(ionosphere_free(fa, fb), 1.0, 1.0) <= kMaxCombinationNoise;
}

// Chooses the pair that has the best first signal, and then the best second signal.
void choose_pair(const BandPlan& bands, SelectedSignals* selected) {
  for (const SignalObservation* a : selected->bands) {
    for (const SignalObservation* b : selected->bands) {
      if (a == b || !is_useful_pair(bands, *a, *b)) continue;
      selected->first = a;
      selected->second = b;
      return;
    }
  }
}

}  // namespace

bool band_comes_first(System system, const SignalPreference& preference, char a, char b,
                      const BandPlan& bands) {
  const int rank_a = band_rank(preference, a);
  const int rank_b = band_rank(preference, b);
  if (rank_a != rank_b) return rank_a < rank_b;
  const double hz_a = bands.frequency_hz(system, a), hz_b = bands.frequency_hz(system, b);
  return hz_a != hz_b ? hz_a > hz_b : a < b;
}

bool signal_comes_first(System system, const SignalPreference& preference, SignalCode a,
                        SignalCode b, const BandPlan& bands) {
  if (a.band != b.band) return band_comes_first(system, preference, a.band, b.band, bands);
  const int attribute_a = preference_rank(preference.attributes, a.attribute);
  const int attribute_b = preference_rank(preference.attributes, b.attribute);
  if (attribute_a != attribute_b) return attribute_a < attribute_b;
  return a.attribute < b.attribute;
}

bool is_plausible_pseudorange(System system, double pseudorange_m) {
  const double smallest = system == System::kLeo ? kMinPseudorangeLeo : kMinPseudorange;
  return pseudorange_m >= smallest && pseudorange_m <= kMaxPseudorange;  // NaN fails
}

SelectedSignals select_signals(std::span<const SignalObservation> observations,
                               const SignalPreference& preference, double cn0_mask_dbhz,
                               const BandPlan& plan) {
  SelectedSignals selected;
  for (const SignalObservation& signal : observations) {
    if (!(plan.frequency_hz(signal.satellite.system, signal.code.band) > 0.0)) continue;
    if (!std::isfinite(signal.pseudorange_m) || signal.pseudorange_m == 0.0) continue;
    selected.any_pseudorange = true;
    if (!is_plausible_pseudorange(signal.satellite.system, signal.pseudorange_m)) continue;
    selected.any_plausible = true;
    if (signal.cn0_dbhz < cn0_mask_dbhz) continue;  // one without C/N0 (NaN) stays

    auto& bands = selected.bands;
    const auto same_band = std::find_if(
        bands.begin(), bands.end(),
        [&](const SignalObservation* other) { return other->code.band == signal.code.band; });
    if (same_band != bands.end()) {
      if (is_better(preference, plan, signal, **same_band)) *same_band = &signal;
    } else if (bands.size() < bands.capacity()) {
      bands.push_back(&signal);
    } else {  // a LEO satellite with more bands than that
      const auto worst = std::max_element(
          bands.begin(), bands.end(), [&](const SignalObservation* a, const SignalObservation* b) {
            return is_better(preference, plan, *a, *b);
          });
      if (is_better(preference, plan, signal, **worst)) *worst = &signal;
    }
  }
  std::sort(selected.bands.begin(), selected.bands.end(),
            [&](const SignalObservation* a, const SignalObservation* b) {
              return is_better(preference, plan, *a, *b);
            });
  if (selected.bands.empty()) return selected;
  selected.first = selected.bands.front();
  choose_pair(plan, &selected);
  return selected;
}

}  // namespace leonav
