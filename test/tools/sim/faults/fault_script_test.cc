// Each scripted fault is there exactly as scripted, and nothing else has changed: every run is held
// against the same one without.
#include "tools/sim/faults/fault_script.h"

#include <cmath>
#include <functional>

#include "core/base/angle.h"
#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/signal.h"
#include "support/catch.h"
#include "support/sky/simulated_receiver.h"
#include "tools/sim/scenario/scenario_yaml.h"

using namespace leonav;
using namespace leonav::test;

namespace {

const std::string kBase = "duration_s: 80\nplaces: [{from_s: 0, place: suburban}]\nfaults: ";

const SimulatedEpochs& clean() {
  static const SimulatedEpochs run = simulate_epochs(kBase + "[]");
  return run;
}

// `t` of the epoch's stamp; `o` with the fault, `plain` without.
using Check =
    std::function<void(double t, const SignalObservation& o, const SignalObservation& plain)>;

// Runs with `fault`; every observation of either run is also in the other, unless `may_lack` says.
int compare(const std::string& fault, const std::function<bool(double, SatelliteId)>& may_lack,
            const Check& check) {
  const SimulatedEpochs run = simulate_epochs(kBase + "[" + fault + "]");
  REQUIRE(run.epochs.size() == clean().epochs.size());
  int count = 0;
  for (std::size_t k = 0; k < run.epochs.size(); ++k) {
    const double t = static_cast<double>(k + 1);
    const BySignal there = by_signal(run.epochs[k]), plain = by_signal(clean().epochs[k]);
    for (const auto& [key, o] : plain) {
      if (!there.contains(key)) REQUIRE(may_lack(t, key.first));
    }
    for (const auto& [key, o] : there) {
      check(t, o, plain.at(key));
      ++count;
    }
  }
  return count;
}

}  // namespace

TEST_CASE("Outage: nothing of those it meets, everything of the others", "[sim][faults]") {
  const auto met = [](SatelliteId s) {
    return s.system == System::kGps || s == SatelliteId{System::kLeo, 12};
  };
  int after = 0;
  compare(
      "{kind: outage, from_s: 20, to_s: 30, systems: [gps], satellites: [L12]}",
      [&](double t, SatelliteId s) { return met(s) && t >= 20.0 && t < 32.0; },
      [&](double t, const SignalObservation& o, const SignalObservation& plain) {
        if (!met(o.satellite) || t < 20.0) {
          REQUIRE(same(o, plain));
          return;
        }
        REQUIRE(t >= 30.0);
        // Code and Doppler as if nothing had been; the carrier counts from another start.
        REQUIRE(o.pseudorange_m == plain.pseudorange_m);
        REQUIRE(o.doppler_hz == plain.doppler_hz);
        REQUIRE(o.cn0_dbhz == plain.cn0_dbhz);
        if (std::isnan(o.carrier_cycles) || std::isnan(plain.carrier_cycles)) return;
        const double twice = 2.0 * (o.carrier_cycles - plain.carrier_cycles);
        REQUIRE(std::abs(twice - std::round(twice)) < 1e-5);
        ++after;
      });
  REQUIRE(after > 300);
}

TEST_CASE("An outage below an elevation leaves the satellites above it", "[sim][faults]") {
  sim::Fault fault;
  fault.kind = sim::FaultKind::kOutage;
  fault.from_s = 20.0;
  fault.to_s = 30.0;
  fault.systems = {System::kGps};
  const SatelliteId gps{System::kGps, 5}, other{System::kGalileo, 5};
  CHECK(sim::FaultScript({fault}).is_out(gps, 89.0 * kDegree, 25.0));  // none is above, unless told
  fault.below_elevation = 50.0 * kDegree;
  const sim::FaultScript script({fault});
  CHECK(script.is_out(gps, 49.9 * kDegree, 25.0));
  CHECK(script.is_out(gps, -5.0 * kDegree, 25.0));
  CHECK_FALSE(script.is_out(gps, 50.1 * kDegree, 25.0));
  CHECK_FALSE(script.is_out(gps, 49.9 * kDegree, 31.0));
  CHECK_FALSE(script.is_out(other, 49.9 * kDegree, 25.0));
  const auto read = sim::load_scenario_text(
      "faults: [{kind: outage, systems: [gps], below_elevation_deg: 50}]\n", "test.yaml");
  CHECK(read.faults.at(0).below_elevation == Approx(50.0 * kDegree));
}

TEST_CASE("A satellite's clock that jumps and drifts is in all it sends", "[sim][faults]") {
  const SatelliteId met = clean().epochs[50].observations.front().satellite;
  int jumped = 0;
  compare(
      "{kind: satellite_clock, from_s: 20, to_s: 50, jump_m: 30, drift_m_s: 0.5, satellites: [" +
          to_string(met) + "]}",
      [](double, SatelliteId) { return false; },
      [&](double t, const SignalObservation& o, const SignalObservation& plain) {
        if (o.satellite != met || t < 20.0 || t >= 50.0) {
          REQUIRE(same(o, plain));
          return;
        }
        const double expected = 30.0 + 0.5 * (t - 20.0);
        REQUIRE(o.pseudorange_m - plain.pseudorange_m == Approx(expected).margin(1e-6));
        REQUIRE(-meters(o, o.doppler_hz - plain.doppler_hz) == Approx(0.5).margin(1e-6));
        ++jumped;
        if (std::isnan(plain.carrier_cycles)) return;
        REQUIRE(meters(o, o.carrier_cycles - plain.carrier_cycles) ==
                Approx(expected).margin(1e-5));
      });
  REQUIRE(jumped >= 30);
}

TEST_CASE("A spoofed satellite is pulled off without a step, and breaks off at the end",
          "[sim][faults]") {
  const SatelliteId met = clean().epochs[50].observations.front().satellite;
  std::map<SignalCode, double> last_pull, last_rate;
  int pulled = 0;
  bool broke = false;
  compare(
      "{kind: spoofing, from_s: 10, to_s: 60, pull_m_s: 2, pull_time_s: 10, satellites: [" +
          to_string(met) + "]}",
      [&](double, SatelliteId) { return false; },
      [&](double t, const SignalObservation& o, const SignalObservation& plain) {
        if (o.satellite != met || t < 10.0) {
          REQUIRE(same(o, plain));
          return;
        }
        const double pull = o.pseudorange_m - plain.pseudorange_m;
        const double rate = -meters(o, o.doppler_hz - plain.doppler_hz);
        if (t >= 60.0) {
          REQUIRE(pull == 0.0);
          REQUIRE(rate == 0.0);
          broke = broke || std::isnan(o.carrier_cycles);
          return;
        }
        ++pulled;
        if (t > 10.0) {
          const double mean = 0.5 * (rate + last_rate[o.code]);
          REQUIRE(pull - last_pull[o.code] == Approx(mean).margin(0.02));
        } else {
          REQUIRE(std::abs(pull) < 1e-9);
        }
        last_pull[o.code] = pull;
        last_rate[o.code] = rate;
        if (t >= 20.0) REQUIRE(rate == Approx(2.0).margin(1e-6));
        if (!std::isnan(plain.carrier_cycles)) {
          REQUIRE(meters(o, o.carrier_cycles - plain.carrier_cycles) == Approx(pull).margin(1e-5));
          REQUIRE(o.loss_of_lock == plain.loss_of_lock);
        }
      });
  REQUIRE(pulled >= 50);
  REQUIRE(broke);
}

TEST_CASE("Faults that name no satellite meet all", "[sim][faults]") {
  sim::Fault fault;
  fault.from_s = 5.0;
  fault.to_s = 6.0;
  const sim::FaultScript script({fault});
  REQUIRE(script.is_out({System::kLeo, 399}, 1.0, 5.0));
  REQUIRE_FALSE(script.is_out({System::kLeo, 399}, 1.0, 4.999));
  REQUIRE_FALSE(script.is_out({System::kLeo, 399}, 1.0, 6.0));
}

TEST_CASE("Faults that make no sense are refused", "[sim][faults]") {
  const auto refused = [](const std::string& fault, const std::string& why) {
    INFO(fault);
    REQUIRE_THROWS_WITH(sim::load_scenario_text("faults: [" + fault + "]", "test.yaml"),
                        Catch::Contains(why) && Catch::Contains("test.yaml:1"));
  };
  refused("{kind: outage, from_s: 10, to_s: 5}", "after from_s");
  refused("{kind: outage, systems: [glonass]}", "glonass");
  refused("{kind: outage, satellites: [X99]}", "X99");
  refused("{kind: imu_gap, satellites: [G01]}", "satellites");
  refused("{kind: outige}", "outage");
  refused("{from_s: 300, to_s: 330}", "kind: must be given");
  refused("{}", "kind: must be given");
  refused("{kind: late, stream: imo}", "imu");
}
