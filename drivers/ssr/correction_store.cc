#include "drivers/ssr/correction_store.h"

#include <algorithm>
#include <cmath>

#include "drivers/ssr/accuracy.h"

namespace leonav {
namespace {

// An issue's number returns after this at the earliest (GPS: IODE differs from those of six hours).
constexpr double kLongestLife_s = 4 * 3600.0;

bool is_within(GpsTime time, GpsTime reference, double limit_s) {
  return std::abs(seconds_between(time, reference)) <= limit_s;
}

}  // namespace

CorrectionCounters& operator+=(CorrectionCounters& sum, const CorrectionCounters& other) {
  sum.states += other.states;
  sum.without_orbit += other.without_orbit;
  sum.without_clock += other.without_clock;
  sum.without_ephemeris += other.without_ephemeris;
  sum.without_bcnav1 += other.without_bcnav1;
  sum.of_other_issue += other.of_other_issue;
  sum.too_old += other.too_old;
  sum.not_reliable += other.not_reliable;
  sum.in_regional_frame += other.in_regional_frame;
  return sum;
}

void CorrectionStore::add(const Ephemeris& ephemeris) {
  if (!is_valid(ephemeris.satellite) || !is_sane(ephemeris)) return;
  const bool is_galileo = ephemeris.satellite.system == System::kGalileo;
  if (is_galileo && ephemeris.message != options_.galileo_message) return;
  std::vector<Ephemeris>& kept = satellites_[ephemeris.satellite].ephemerides;
  std::erase_if(kept, [&](const Ephemeris& old) {
    return old.message == ephemeris.message && old.issue == ephemeris.issue &&
           old.toe == ephemeris.toe;
  });
  if (kept.size() == kIssuesKept) kept.erase(kept.begin());
  kept.push_back(ephemeris);
}

void CorrectionStore::add(const SsrMessage& message) {
  if (message.is_regional_frame) {
    counters_.in_regional_frame += message.satellites.size();
    return;
  }
  const Correction correction{message.time,    reference_time(message), source_of(message),
                              message.service, message.validity_s,      message.at_antenna};
  for (const SsrSatellite& from : message.satellites) {
    if (!is_valid(from.satellite)) continue;
    Satellite& to = satellites_[from.satellite];
    if (from.orbit_ends) to.orbit_is = {};
    if (from.clock_ends) to.clock = to.earlier_clock = {};
    if (from.orbit) {
      // A clock's correction belongs to the elements that the orbit of its time corrects.
      const bool is_other_issue =
          !from.orbit->correction_issue &&
          (from.orbit->issue != to.orbit.issue || from.orbit->beidou_toe != to.orbit.beidou_toe);
      if (is_other_issue && to.clock.is.sent < message.time) to.clock = {};
      to.orbit = *from.orbit;
      to.orbit_is = correction;
    }
    if (from.clock) {
      if (from.clock->correction_issue != to.clock.values.correction_issue) {
        to.earlier_clock = to.clock;
      }
      to.clock = {*from.clock, correction};
    }
    if (from.high_rate_clock_m) {
      to.high_rate_m = *from.high_rate_clock_m;
      to.high_rate_is = correction;
    }
    if (from.accuracy_index) to.accuracy_index = *from.accuracy_index;
  }
}

std::vector<CorrectedState> CorrectionStore::states(const SsrMessage& message, GpsTime time) {
  std::vector<CorrectedState> states;
  if (message.is_regional_frame) return states;
  for (const SsrSatellite& from : message.satellites) {
    const auto satellite = satellites_.find(from.satellite);
    if (satellite == satellites_.end()) continue;
    if (const auto one = state(from.satellite, satellite->second, time)) states.push_back(*one);
  }
  counters_.states += states.size();
  return states;
}

// Whether orbit and clock are of one solution.
bool CorrectionStore::go_together(const Satellite& s, const Clock& clock) {
  return s.orbit_is.service == clock.is.service && s.orbit_is.source == clock.is.source &&
         s.orbit.correction_issue == clock.values.correction_issue;
}

std::optional<CorrectedState> CorrectionStore::state(SatelliteId id, const Satellite& s,
                                                     GpsTime time) {
  const auto none = [](std::uint64_t* counter) {
    ++*counter;
    return std::nullopt;
  };
  if (!s.orbit_is.reference.is_set()) return none(&counters_.without_orbit);
  if (!s.clock.is.reference.is_set()) return none(&counters_.without_clock);
  const bool has_earlier = !go_together(s, s.clock) && s.earlier_clock.is.reference.is_set();
  const Clock& clock = has_earlier ? s.earlier_clock : s.clock;
  if (!go_together(s, clock)) return none(&counters_.of_other_issue);
  if (!is_within(time, s.orbit_is.reference,
                 s.orbit_is.validity_s.value_or(options_.max_orbit_age_s)) ||
      !is_within(time, clock.is.reference,
                 clock.is.validity_s.value_or(options_.max_clock_age_s))) {
    return none(&counters_.too_old);
  }
  if (s.accuracy_index == kWorstSsrAccuracy) return none(&counters_.not_reliable);
  const Ephemeris* broadcast = corrected_ephemeris(s, time);
  if (broadcast == nullptr) {
    const bool is_of_bcnav1 =
        s.orbit_is.service == SsrService::kBeidouB2b && id.system == System::kBeidou;
    return none(is_of_bcnav1 ? &counters_.without_bcnav1 : &counters_.without_ephemeris);
  }

  OrbitAndClock corrections{s.orbit, s.orbit_is.reference, clock.values, clock.is.reference, 0.0};
  const bool has_high_rate =
      s.high_rate_is.reference.is_set() && s.high_rate_is.source == clock.is.source &&
      s.high_rate_is.sent >= clock.is.sent &&
      is_within(time, s.high_rate_is.reference, options_.max_high_rate_age_s);
  if (has_high_rate) corrections.high_rate_clock_m = s.high_rate_m;
  CorrectedState state = apply(corrections, *broadcast, time);
  if (has_high_rate) state.corrected_at = s.high_rate_is.reference;
  state.at_antenna = s.orbit_is.at_antenna.value_or(options_.at_antenna);
  state.sigma_m = ssr_accuracy_m(s.accuracy_index).value_or(options_.default_sigma_m);
  return state;
}

const Ephemeris* CorrectionStore::corrected_ephemeris(const Satellite& s, GpsTime time) const {
  const Ephemeris* nearest = nullptr;
  double nearest_s = kLongestLife_s;
  for (const Ephemeris& e : s.ephemerides) {
    const double age_s = std::abs(seconds_between(time, e.toe));
    if (age_s > nearest_s || !is_corrected_by(e, s.orbit, s.orbit_is.service)) continue;
    nearest = &e;
    nearest_s = age_s;
  }
  return nearest;
}

CorrectionSource source_of(const SsrMessage& message) {
  return {message.provider, message.solution, message.issue};
}

bool has_clocks(const SsrMessage& message) {
  return message.kind == SsrKind::kClock || message.kind == SsrKind::kOrbitAndClock ||
         message.kind == SsrKind::kHighRateClock;
}

std::vector<SignalBias> biases_of(const SsrMessage& message, GpsTime time) {
  std::vector<SignalBias> biases;
  const auto add = [&](SatelliteId satellite, BiasKind kind, const SsrBias& bias) {
    biases.push_back({satellite, bias.code, kind, time, -bias.bias_m});
    const bool is_p_of_has = message.service == SsrService::kGalileoHas &&
                             satellite.system == System::kGps && bias.code == SignalCode{'2', 'P'};
    if (is_p_of_has) biases.push_back({satellite, {'2', 'W'}, kind, time, -bias.bias_m});
  };
  for (const SsrSatellite& satellite : message.satellites) {
    for (const SsrBias& bias : satellite.code_biases) {
      add(satellite.satellite, BiasKind::kCode, bias);
    }
    for (const SsrBias& bias : satellite.phase_biases) {
      add(satellite.satellite, BiasKind::kPhase, bias);
    }
  }
  std::erase_if(biases, [](const SignalBias& bias) { return !is_sane(bias); });
  return biases;
}

}  // namespace leonav
