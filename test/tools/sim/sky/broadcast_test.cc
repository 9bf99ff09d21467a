// Broadcast messages fitted to simulated orbits, judged by the receiver's own model of them.
#include "tools/sim/sky/broadcast.h"

#include <cmath>

#include "core/gnss/orbits/satellite_state.h"
#include "core/gnss/propagation/group_delay.h"
#include "core/gnss/signals/band_plan.h"
#include "support/catch.h"
#include "tools/sim/scenario/scenario_yaml.h"

using namespace leonav;
using namespace leonav::sim;

namespace {

Scenario scenario_with(const std::string& keys) {
  return load_scenario_text("duration_s: 3600\nsatellites:\n  leo: {enabled: false}\n" + keys,
                            "scenario.yaml");
}

std::string quiet(const std::string& system) {
  return "  " + system +
         ": {clock: {noise_s_per_sqrt_s: 0}, broadcast: {orbit_error_m: 0, clock_error_m: 0}}\n";
}

double seconds(const Scenario& scenario, GpsTime time) {
  return seconds_between(time, scenario.start);
}

}  // namespace

TEST_CASE("Broadcast elements follow their orbits, geostationary and inclined ones too") {
  const Scenario scenario = scenario_with(quiet("gps") + quiet("galileo") + quiet("beidou"));
  const TrueSky sky = build_sky(scenario);
  const BroadcastMessages messages = make_broadcast(scenario, sky);
  for (const System system : {System::kGps, System::kGalileo, System::kBeidou}) {
    const FitStatistics& fit = messages.residuals[index_of(system)];
    INFO(to_string(system) << ": rms " << fit.rms_m() << " m, worst " << fit.worst_m << " m");
    CHECK(fit.count > 50);
    // GPS: four hours of an eccentric orbit; fifteen elements leave that much of the Earth's
    // flattening.
    CHECK(fit.rms_m() < (system == System::kGps ? 0.15 : 0.01));
    CHECK(fit.worst_m < (system == System::kGps ? 0.5 : 0.05));
  }
  for (const Ephemeris& e : messages.ephemerides) {
    INFO(to_string(e.satellite));
    REQUIRE(is_sane(e));
    const bool geostationary = is_beidou_geostationary(e.satellite);
    CHECK((e.message == NavigationMessage::kBeidouD2) == geostationary);
    CHECK((e.i0 < 0.2) == geostationary);  // 5 degrees in their tilted frame
  }
}

// Their arcs last twelve minutes; from one issue to the next the orbit goes on.
TEST_CASE("Broadcast elements of low satellites follow their orbits to millimetres") {
  const Scenario scenario = load_scenario_text(
      "duration_s: 1200\nsatellites:\n  gps: {enabled: false}\n  galileo: {enabled: false}\n"
      "  beidou: {enabled: false}\n  leo: {told: broadcast, only_risen: true, "
      "clock: {noise_s_per_sqrt_s: 0}, broadcast: {issue_interval_s: 600, orbit_error_m: 0, "
      "clock_error_m: 0}}\n",
      "scenario.yaml");
  const TrueSky sky = build_sky(scenario);
  const BroadcastMessages messages = make_broadcast(scenario, sky);
  const FitStatistics& fit = messages.residuals[index_of(System::kLeo)];
  INFO("rms " << fit.rms_m() << " m, worst " << fit.worst_m << " m of " << fit.count);
  CHECK(fit.count > 50);
  CHECK(fit.rms_m() < 0.01);
  CHECK(fit.worst_m < 0.05);
  for (const Ephemeris& e : messages.ephemerides) {
    INFO(to_string(e.satellite));
    REQUIRE(is_sane(e));
    CHECK(seconds_between(e.toe, e.transmission_time) == 300.0);
    for (const TrueSatellite& satellite : sky.satellites) {
      if (satellite.id != e.satellite) continue;
      for (const double t : {-300.0, 0.0, 250.5}) {  // between the samples too
        const double at = seconds(scenario, e.toe) + t;
        const SatelliteState state = broadcast_state(e, e.toe.plus_seconds(t));
        CHECK((state.p_e - to_earth(satellite.orbit.at(at).p_i, at)).norm() < 0.05);
        CHECK(std::abs(state.clock_s - clock_s(satellite, at)) < 1e-10);
      }
    }
  }
}

// Code = range - c clock + delay of the signal. Whoever applies the message's clock and group
// delay, or the precise clock and nothing for the pair that it refers to, must get the range.
TEST_CASE("Clocks and group delays of messages and of precise products agree on the signals") {
  const Scenario scenario = scenario_with(quiet("gps") + quiet("galileo") + quiet("beidou"));
  const TrueSky sky = build_sky(scenario);
  const BroadcastMessages messages = make_broadcast(scenario, sky);
  const auto satellite_of = [&](SatelliteId id) {
    return *std::find_if(sky.satellites.begin(), sky.satellites.end(),
                         [id](const TrueSatellite& s) { return s.id == id; });
  };
  double largest = 0.0;
  for (const Ephemeris& e : messages.ephemerides) {
    const TrueSatellite truth = satellite_of(e.satellite);
    const System system = e.satellite.system;
    const GpsTime time = e.toe.plus_seconds(600.0);
    const double told_m = kSpeedOfLight * broadcast_state(e, time).clock_s;
    const double true_m = kSpeedOfLight * clock_s(truth, seconds(scenario, time));
    std::vector<SignalCode> codes = {{'1', 'W'}, {'2', 'W'}};
    if (system == System::kGalileo) codes = {{'1', 'C'}, {'5', 'Q'}, {'7', 'Q'}};
    if (system == System::kBeidou) codes = {{'2', 'I'}, {'6', 'I'}, {'7', 'I'}};
    for (const SignalCode code : codes) {
      const double delay_m = signal_delay_m(system, truth.group_delay_m, code.band);
      largest = std::max(largest, std::abs(delay_m));
      const double by_message_m = told_m - group_delay(e, code).delay_m;
      INFO(to_string(e.satellite) << " " << to_string(code));
      // The message's relativistic term is of a Kepler orbit: 0.04 ns.
      CHECK(std::abs(by_message_m - (true_m - delay_m)) < 0.03);
    }
    const double pair_m = precise_group_delay(system, &e, codes[0], codes[1]).delay_m;
    const double f1 = BandPlan().frequency_hz(system, codes[0].band),
                 f2 = BandPlan().frequency_hz(system, codes[1].band);
    const double gamma = f1 * f1 / (f1 * f1 - f2 * f2);
    const double simulated_m =
        gamma * signal_delay_m(system, truth.group_delay_m, codes[0].band) +
        (1.0 - gamma) * signal_delay_m(system, truth.group_delay_m, codes[1].band);
    CHECK(simulated_m == Approx(pair_m).margin(1e-9));
    CHECK(simulated_m == Approx(0.0).margin(1e-9));
  }
  CHECK(largest > 3.0);  // there was something to agree on
}

TEST_CASE("Issues come as often as they should, and their errors are of the size asked for") {
  const Scenario scenario = scenario_with(
      "  gps: {clock: {noise_s_per_sqrt_s: 0}, broadcast: {along_error_m: 3, cross_error_m: 0, "
      "radial_error_m: 0, clock_error_m: 0}}\n  galileo: {broadcast: {issue_interval_s: 3600}}\n");
  const TrueSky sky = build_sky(scenario);
  double sum = 0.0, off_track = 0.0;
  int gps = 0, galileo = 0;
  for (const Ephemeris& e : make_broadcast(scenario, sky).ephemerides) {
    if (e.satellite.system == System::kGalileo) ++galileo;
    if (e.satellite.system != System::kGps) continue;
    ++gps;
    CHECK(std::fmod(e.toe.tow_s(), 7200.0) == 0.0);
    CHECK(seconds_between(e.toe, e.transmission_time) == 7200.0);
    const auto truth = std::find_if(sky.satellites.begin(), sky.satellites.end(),
                                    [&](const auto& s) { return s.id == e.satellite; });
    const double t = seconds(scenario, e.toe);
    const OrbitState state = truth->orbit.at(t);
    const Eigen::Vector3d miss = broadcast_state(e, e.toe).p_e - to_earth(state.p_i, t);
    const double along = miss.dot(to_earth(state.v_i, t).normalized());
    sum += along * along;
    off_track = std::max(off_track, std::sqrt(miss.squaredNorm() - along * along));
  }
  CHECK(gps == 2 * 31);            // the one in force and the one before
  CHECK(galileo == (2 + 1) * 24);  // an hour of hours
  // A sine and a cosine of one sigma each, at one instant.
  CHECK(std::sqrt(sum / gps) == Approx(3.0).epsilon(0.3));
  CHECK(off_track < 0.5);
}
