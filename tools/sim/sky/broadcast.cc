#include "tools/sim/sky/broadcast.h"

#include <algorithm>
#include <cmath>

#include "core/gnss/orbits/satellite_state.h"
#include "core/gnss/signals/signal.h"
#include "tools/sim/sky/ephemeris_error.h"

namespace leonav::sim {
namespace {

constexpr int kSamplesPerSide = 16;
// Issues of a low satellite overlap by so much on either side.
constexpr double kLowOverlap_s = 60.0;

NavigationMessage message_of(SatelliteId satellite) {
  switch (satellite.system) {
    case System::kGalileo:
      return NavigationMessage::kGalileoInav;
    case System::kBeidou:
      return is_beidou_geostationary(satellite) ? NavigationMessage::kBeidouD2
                                                : NavigationMessage::kBeidouD1;
    case System::kGps:
    case System::kLeo:
      break;
  }
  return NavigationMessage::kGpsLnav;
}

// Returns half the arc that an issue is fitted to: the validity in the interface document, or
// slightly more.
double half_span_s(System system, double interval_s) {
  if (system == System::kGps) return 7200.0;
  if (system == System::kLeo) return 0.5 * interval_s + kLowOverlap_s;
  return system == System::kGalileo ? 3600.0 : 5400.0;  // eccentric Galileo orbits need short arcs
}
double lead_s(System system, double interval_s) {
  if (system == System::kLeo) return 0.5 * interval_s;
  return system == System::kGps ? 7200.0 : 0.0;
}

// The smallest URA and SISA that occur in messages.
double accuracy_m(System system) {
  if (system == System::kLeo) return 1.0;
  return system == System::kGalileo ? 3.12 : 2.0;
}

// Returns the state with axes rotated to those of ECEF at `t`.
OrbitState at_own_axes(const OrbitState& state, double t) {
  return {to_earth(state.p_i, t), to_earth(state.v_i, t)};
}

}  // namespace

double FitStatistics::rms_m() const {
  return count == 0 ? 0.0 : std::sqrt(sum_m2 / static_cast<double>(count));
}

void FitStatistics::add(const EphemerisFit& fit) {
  ++count;
  sum_m2 += fit.rms_m * fit.rms_m;
  worst_m = std::max(worst_m, fit.worst_m);
}

EphemerisFit fit_issue(const Scenario& scenario, const TrueSatellite& satellite,
                       const IssueRequest& request) {
  Ephemeris given;
  given.satellite = request.as;
  given.message = message_of(request.as);
  given.toe = given.toc = scenario.start.plus_seconds(request.toe_s);
  given.transmission_time = given.toe.plus_seconds(-request.lead_s);
  const auto tow = static_cast<std::int64_t>(std::llround(given.toe.tow_s()));
  given.issue = given.issue_clock = static_cast<std::uint16_t>(tow / 600 % 256);
  given.health = satellite.health;
  given.accuracy_m = accuracy_m(request.as.system);

  std::vector<OrbitSample> samples;
  const double step = request.half_span_s / kSamplesPerSide;
  for (int i = -kSamplesPerSide; i <= kSamplesPerSide; ++i) {
    const double t = request.toe_s + i * step;
    const OrbitState truth = satellite.orbit.at(t);
    samples.push_back({scenario.start.plus_seconds(t),
                       to_earth(truth.p_i + in_inertial(truth, request.orbit_error_m), t)});
  }
  const OrbitState at_toe = at_own_axes(satellite.orbit.at(request.toe_s), request.toe_s);
  EphemerisFit fit = fit_ephemeris(given, at_toe, samples);
  // The clock polynomial is the straight line over the arc of what the user's relativistic term
  // leaves of the true clock: with fitted elements that term is not quite that of the orbit.
  const auto left_s = [&](double t) {
    return clock_s(satellite, t) -
           broadcast_state(fit.elements, scenario.start.plus_seconds(t)).clock_s;
  };
  const double before = left_s(request.toe_s - request.half_span_s);
  const double after = left_s(request.toe_s + request.half_span_s);
  const double reference_m = broadcast_reference_m(given.message, satellite.group_delay_m);
  const double at_toe_s = left_s(request.toe_s);
  Ephemeris& e = fit.elements;
  e.af1 = (after - before) / (2.0 * request.half_span_s);
  e.af0 = at_toe_s + (request.clock_error_m - reference_m) / kSpeedOfLight;
  for (std::size_t i = 0; i < 2; ++i) {
    e.group_delay_s[i] = satellite.group_delay_m[i] / kSpeedOfLight;
  }
  return fit;
}

BroadcastMessages make_broadcast(const Scenario& scenario, const TrueSky& sky) {
  BroadcastMessages messages;
  for (const TrueSatellite& satellite : sky.satellites) {
    const ConstellationConfig& c = scenario.constellations[satellite.constellation];
    if (c.provided == ProvidedProducts::kPrecise) continue;
    EphemerisErrors errors = c.broadcast.errors;
    errors.update_s = c.broadcast.issue_interval_s;
    const EphemerisError error(errors, satellite.id, period_s(satellite.orbit.at(0.0)),
                               scenario.seed, "broadcast");
    const double interval = c.broadcast.issue_interval_s;
    const double start_tow = scenario.start.tow_s();
    // The issues begin with the one in force at the start and the one before.
    double toe =
        std::floor((start_tow + lead_s(c.system, interval)) / interval) * interval - start_tow;
    for (toe -= interval; toe <= scenario.duration_s + lead_s(c.system, interval);
         toe += interval) {
      const IssueRequest request{satellite.id,
                                 toe,
                                 half_span_s(c.system, interval),
                                 error.orbit_m(toe),
                                 error.clock_m(toe),
                                 lead_s(c.system, interval)};
      const EphemerisFit fit = fit_issue(scenario, satellite, request);
      messages.residuals[index_of(c.system)].add(fit);
      messages.ephemerides.push_back(fit.elements);
    }
  }
  return messages;
}

}  // namespace leonav::sim
