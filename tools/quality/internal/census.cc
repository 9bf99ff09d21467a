#include "tools/quality/internal/census.h"

#include <algorithm>
#include <cmath>

#include "core/gnss/measurement/weighting.h"
#include "core/gnss/preprocessing/signal_selection.h"

namespace leonav {
namespace {

constexpr double kGapFactor = 1.5;
constexpr double kNearlyAsOften = 0.9;

bool has_both(const BandPlan& bands, const SignalObservation& o) {
  return std::isfinite(o.carrier_cycles) && std::isfinite(o.pseudorange_m) &&
         bands.frequency_hz(o.satellite.system, o.code.band) > 0.0;
}

bool is_useful(const BandPlan& bands, System system, char a, char b) {
  const IonosphereFree pair =
      ionosphere_free(bands.frequency_hz(system, a), bands.frequency_hz(system, b));
  return combined_sigma(pair, 1.0, 1.0) <= kMaxCombinationNoise;
}

}  // namespace

void Census::add(const RawEpoch& epoch) {
  if (times_.last.is_set() && epoch.time <= times_.last) {
    ++times_.backwards;
    return;
  }
  if (times_.last.is_set()) {
    const double interval_s = seconds_between(epoch.time, times_.last);
    ++intervals_[std::llround(interval_s * 1e3)];
  } else {
    times_.first = epoch.time;
  }
  times_.last = epoch.time;
  ++times_.epochs;
  for (const SignalObservation& o : epoch.observations) {
    if (!has_both(config_.bands, o)) continue;
    auto& signals = satellites_[o.satellite];
    auto found = std::find_if(signals.begin(), signals.end(),
                              [&](const SignalCount& s) { return s.code == o.code; });
    if (found == signals.end()) found = signals.insert(signals.end(), {o.code, 0});
    ++found->carriers;
  }
}

EpochTimes Census::times() const {
  EpochTimes times = times_;
  std::uint64_t most = 0;
  for (const auto& [ms, count] : intervals_) {
    if (count <= most) continue;
    most = count;
    times.interval_s = static_cast<double>(ms) * 1e-3;
  }
  for (const auto& [ms, count] : intervals_) {
    const double interval_s = static_cast<double>(ms) * 1e-3;
    if (!(times.interval_s > 0.0 && interval_s > kGapFactor * times.interval_s)) continue;
    times.gaps += count;
    times.missing += static_cast<double>(count) * (std::round(interval_s / times.interval_s) - 1.0);
    times.longest_gap_s = interval_s;
  }
  return times;
}

std::map<SatelliteId, CarrierPlan> Census::plans() const {
  std::map<SatelliteId, CarrierPlan> plans;
  for (const auto& [satellite, signals] : satellites_)
    plans[satellite] = plan_of(satellite.system, signals);
  return plans;
}

CarrierPlan Census::plan_of(System system, const std::vector<SignalCount>& signals) const {
  const SignalPreference& preference = config_.systems[index_of(system)].signals;
  const auto attribute_place = [&](SignalCode code) {
    return std::find(preference.attributes.begin(), preference.attributes.end(), code.attribute) -
           preference.attributes.begin();
  };
  // The list gets the most frequent signal of each band; among equals, the one the navigator
  // prefers.
  std::vector<SignalCount> bands;
  for (const SignalCount& signal : signals) {
    const auto same = std::find_if(bands.begin(), bands.end(), [&](const SignalCount& other) {
      return other.code.band == signal.code.band;
    });
    if (same == bands.end()) {
      bands.push_back(signal);
      continue;
    }
    const bool preferred = std::pair(attribute_place(signal.code), signal.code.attribute) <
                           std::pair(attribute_place(same->code), same->code.attribute);
    if (signal.carriers > same->carriers || (signal.carriers == same->carriers && preferred))
      *same = signal;
  }
  const auto comes_first = [&](const SignalCount& a, const SignalCount& b) {
    return band_comes_first(system, preference, a.code.band, b.code.band, config_.bands);
  };
  std::sort(bands.begin(), bands.end(), comes_first);
  const auto take_best = [&](auto&& counts) {
    std::uint64_t most = 0;
    for (const SignalCount& band : bands) {
      if (counts(band)) most = std::max(most, band.carriers);
    }
    const auto best = std::find_if(bands.begin(), bands.end(), [&](const SignalCount& band) {
      return counts(band) &&
             static_cast<double>(band.carriers) >= kNearlyAsOften * static_cast<double>(most);
    });
    const SignalCode code = best->code;
    bands.erase(best);
    return code;
  };
  const auto any = [](const SignalCount&) { return true; };
  CarrierPlan plan;
  plan.reference = take_best(any);
  const auto useful = [&](const SignalCount& band) {
    return is_useful(config_.bands, system, plan.reference.band, band.code.band);
  };
  if (std::any_of(bands.begin(), bands.end(), useful)) plan.others.push_back(take_best(useful));
  while (!bands.empty()) plan.others.push_back(take_best(any));
  return plan;
}

}  // namespace leonav
