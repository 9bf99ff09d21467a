#include "drivers/epoch/epoch_capacity.h"

#include <algorithm>
#include <iterator>

#include "core/gnss/preprocessing/signal_selection.h"

namespace leonav {
namespace {

constexpr int kNoFrequency = 99;  // after all others: of a band that the system does not have

// A signal with its place among those of its satellite.
struct Ranked {
  const SignalObservation* signal = nullptr;
  int of_frequency = 0;  // 0: the first on its frequency
  int frequency = 0;     // 0: the first frequency of the satellite
};

// Ranks the signals of one satellite. A signal without a code cannot be chosen by the estimator, so
// that it comes after those that have one.
void rank(const SignalPreference& preference, const BandPlan& bands,
          std::vector<Ranked>::iterator begin, std::vector<Ranked>::iterator end) {
  std::sort(begin, end, [&](const Ranked& a, const Ranked& b) {
    const SignalObservation &x = *a.signal, &y = *b.signal;
    const System system = x.satellite.system;
    if (x.code.band != y.code.band)
      return band_comes_first(system, preference, x.code.band, y.code.band, bands);
    const bool x_has_code = is_plausible_pseudorange(system, x.pseudorange_m);
    const bool y_has_code = is_plausible_pseudorange(system, y.pseudorange_m);
    if (x_has_code != y_has_code) return x_has_code;
    return signal_comes_first(system, preference, x.code, y.code, bands);
  });
  for (auto i = begin; i < end; ++i) {
    const SignalObservation& signal = *i->signal;
    if (!is_band_of(signal.satellite.system, signal.code.band)) {
      i->of_frequency = kNoFrequency;
      continue;
    }
    if (i == begin) continue;
    const bool same_band = i->signal->code.band == (i - 1)->signal->code.band;
    i->of_frequency = same_band ? (i - 1)->of_frequency + 1 : 0;
    i->frequency = (i - 1)->frequency + (same_band ? 0 : 1);
  }
}

std::string names_of(const std::set<std::pair<System, SignalCode>>& codes) {
  std::string text;
  for (auto i = codes.begin(); i != codes.end(); ++i) {
    const bool same_system = i != codes.begin() && std::prev(i)->first == i->first;
    if (!same_system) text += (text.empty() ? "" : ", ") + std::string(to_string(i->first));
    text += " " + to_string(i->second);
  }
  return text;
}

std::string limit_text() { return std::to_string(kMaxObservations) + " that an epoch holds"; }

}  // namespace

void EpochCapacity::fit(std::vector<SignalObservation>* signals, RawEpoch* epoch) {
  if (!std::is_sorted(signals->begin(), signals->end(), comes_before))
    std::sort(signals->begin(), signals->end(), comes_before);
  if (signals->size() > kMaxObservations) keep_usable(signals);
  epoch->observations.assign(signals->begin(), signals->end());
}

void EpochCapacity::keep_usable(std::vector<SignalObservation>* signals) {
  std::vector<Ranked> ranked;
  for (const SignalObservation& signal : *signals) ranked.push_back({&signal});
  for (auto begin = ranked.begin(); begin != ranked.end();) {
    const SatelliteId satellite = begin->signal->satellite;
    const auto end = std::find_if(
        begin, ranked.end(), [&](const Ranked& r) { return r.signal->satellite != satellite; });
    rank(config_.systems[index_of(satellite.system)].signals, config_.bands, begin, end);
    begin = end;
  }
  std::stable_sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return std::pair(a.of_frequency, a.frequency) < std::pair(b.of_frequency, b.frequency);
  });
  for (std::size_t i = kMaxObservations; i < ranked.size(); ++i) {
    const SignalObservation& lost = *ranked[i].signal;
    const bool usable = ranked[i].of_frequency == 0;
    ++(usable ? losses_.usable : losses_.spare);
    (usable ? losses_.usable_codes : losses_.spare_codes)
        .insert({lost.satellite.system, lost.code});
  }
  std::vector<SignalObservation> kept;
  for (std::size_t i = 0; i < kMaxObservations; ++i) kept.push_back(*ranked[i].signal);
  std::sort(kept.begin(), kept.end(), comes_before);
  *signals = std::move(kept);
}

std::string spare_text(const CapacityLosses& losses) {
  if (losses.spare == 0) return {};
  return "signal beyond the " + limit_text() + " (" + names_of(losses.spare_codes) +
         "): of each frequency of its satellite another code was kept, and a configuration with "
         "the default order of codes uses none of these";
}

std::string usable_text(const CapacityLosses& losses) {
  if (losses.usable == 0) return {};
  return "signal beyond the " + limit_text() + " (" + names_of(losses.usable_codes) +
         "), though no other code of its frequency was kept: the solution goes without it; record "
         "fewer satellites or frequencies";
}

std::string summary_of(const CapacityLosses& losses) {
  std::string text;
  const auto add = [&](std::uint64_t count, const char* what,
                       const std::set<std::pair<System, SignalCode>>& codes) {
    if (count == 0) return;
    text += (text.empty() ? "beyond the " + limit_text() + ": " : ", ") + std::to_string(count) +
            what + names_of(codes) + ")";
  };
  add(losses.spare, " spare signals (", losses.spare_codes);
  add(losses.usable, " usable signals (", losses.usable_codes);
  return text;
}

}  // namespace leonav
