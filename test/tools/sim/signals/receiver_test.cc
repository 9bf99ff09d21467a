// What a simulated receiver measures, held against physics that it does not compute by.
#include "tools/sim/signals/receiver.h"

#include <cmath>

#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/signal.h"
#include "support/catch.h"
#include "support/sky/simulated_receiver.h"

using namespace leonav;
using namespace leonav::test;

namespace {

const std::string kDrive = "duration_s: 120\nroute: {standing_s: 20}\n";

// Calls `check(before, now, after)` for each signal that three epochs in a row hold by its carrier.
template <typename Check>
int for_each_triple(const std::vector<RawEpoch>& epochs, const Check& check) {
  int count = 0;
  for (std::size_t k = 1; k + 1 < epochs.size(); ++k) {
    const BySignal before = by_signal(epochs[k - 1]), after = by_signal(epochs[k + 1]);
    for (const SignalObservation& now : epochs[k].observations) {
      const auto a = before.find({now.satellite, now.code});
      const auto b = after.find({now.satellite, now.code});
      if (a == before.end() || b == after.end()) continue;
      if (!(a->second.lock_time_s < now.lock_time_s && now.lock_time_s < b->second.lock_time_s))
        continue;
      if (a->second.half_cycle_ambiguous != b->second.half_cycle_ambiguous) continue;
      check(a->second, now, b->second);
      ++count;
    }
  }
  return count;
}

// Against a difference of carriers over 0.1 s.
double worst_doppler_error(const Keys& keys, int* count) {
  const SimulatedEpochs run = simulate_epochs(kDrive + "receiver: {interval_s: 0.05}", keys);
  double worst = 0.0;
  *count = for_each_triple(run.epochs, [&](const auto& before, const auto& now, const auto& after) {
    const double rate = meters(now, after.carrier_cycles - before.carrier_cycles) / 0.1;
    worst = std::max(worst, std::abs(rate + meters(now, now.doppler_hz)));
  });
  return worst;
}

}  // namespace

TEST_CASE("A satellite's signals do not depend on which others exist", "[sim]") {
  const SimulatedEpochs all = simulate_epochs(kDrive, {"places=city"});
  const SimulatedEpochs few = simulate_epochs(
      kDrive, {"places=city", "satellites.gps.enabled=false", "satellites.beidou.enabled=false"});
  REQUIRE(all.epochs.size() == few.epochs.size());
  int compared = 0;
  for (std::size_t k = 0; k < all.epochs.size(); ++k) {
    const BySignal whole = by_signal(all.epochs[k]);
    for (const SignalObservation& o : few.epochs[k].observations) {
      REQUIRE(same(o, whole.at({o.satellite, o.code})));
      ++compared;
    }
  }
  REQUIRE(compared > 2000);
}

TEST_CASE("The same seed gives the same epochs, another one others", "[sim]") {
  const SimulatedEpochs a = simulate_epochs(kDrive), b = simulate_epochs(kDrive),
                        other = simulate_epochs(kDrive, {"seed=2"});
  for (std::size_t k = 0; k < a.epochs.size(); ++k) {
    REQUIRE(same(a.epochs[k], b.epochs[k]));
    REQUIRE_FALSE(same(a.epochs[k], other.epochs[k]));
  }
}

TEST_CASE("The Doppler is the rate of the carrier", "[sim]") {
  int count = 0;
  const Keys standing = {"ideal=true", "receiver.clock.oscillator=ideal", "duration_s=20"};
  REQUIRE(worst_doppler_error(standing, &count) < 5e-4);
  REQUIRE(count > 20'000);
  // Driving, the difference itself is wrong by the jerk, 3 m/s^3, times 0.05^2 / 6 and by the
  // body's swing; a turn of 0.5 rad/s that the Doppler lacked would be 20 mm/s.
  const Keys driving = {"ideal=true", "receiver.clock.oscillator=ideal"};
  REQUIRE(worst_doppler_error(driving, &count) < 6e-3);
  REQUIRE(count > 100'000);
  const Keys street = {"ideal=true", "receiver.clock.oscillator=ideal",
                       "places=[{from_s: 0, place: urban_canyon}]"};
  REQUIRE(worst_doppler_error(street, &count) < 6e-3);
  REQUIRE(count > 30'000);
}

TEST_CASE("A Doppler counts by the receiver's own seconds, as its carriers do", "[sim]") {
  // Carriers are stamped by the receiver's clock, so that their differences know nothing of what
  // the Doppler is computed by. (rate + c drift) (1 - drift) instead of rate + c drift: 3 cm/s that
  // are common to all, and 6 cm/s at 6 km/s.
  int count = 0;
  const Keys fast = {"ideal=true", "receiver.clock.oscillator=ideal", "duration_s=20",
                     "receiver.clock.drift_ppb=10000"};
  REQUIRE(worst_doppler_error(fast, &count) < 5e-4);
  REQUIRE(count > 20'000);
}

TEST_CASE("Reflections grow old as their satellite crosses the sky", "[sim]") {
  const auto age_after = [](double t, double elevation, LookAngles rates) {
    sim::MultipathAge age;
    for (double s = 0.0; s <= t; s += 1.0) age.advance(s, elevation, rates);
    return age.seconds();
  };
  // Medium orbit, low orbit, and one that stands still over the equator.
  CHECK(age_after(60.0, 0.0, {.elevation = 1.2e-4, .azimuth = 0.0}) == Approx(60.0));
  CHECK(age_after(60.0, 1.0, {.elevation = 0.0, .azimuth = 6e-3}) ==
        Approx(60.0 * 50.0 * std::cos(1.0)));
  CHECK(age_after(60.0, 0.5, {.elevation = 0.0, .azimuth = 0.0}) == Approx(6.0));
}

TEST_CASE("Multipath moves carrier and Doppler together", "[sim]") {
  // A wave over many metres, large, and long enough for satellites in low orbit, whose reflections
  // change fifty times as fast: what differences over 0.2 s do not resolve is small.
  const std::string yaml =
      kDrive + "ideal: true\nreceiver: {interval_s: 0.1, clock: {oscillator: ideal}}";
  const SimulatedEpochs plain = simulate_epochs(yaml);
  sim::Scenario scenario = sim::load_scenario_text(yaml, "test.yaml");
  scenario.receiver.multipath = {0.0, 0.05, 1.0, 400.0, 50.0};
  const SplineMotion motion = sim::drive(scenario);
  const sim::TrueSky sky = sim::build_sky(scenario);
  const sim::FaultScript none({});
  sim::Receiver receiver(scenario, motion, sky, none);
  double carrier_sum = 0.0, worst = 0.0, doppler_sum = 0.0;
  int count = 0;
  std::map<std::pair<SatelliteId, SignalCode>, std::array<double, 2>> last;  // carrier, Doppler
  for (std::size_t k = 0; k < plain.epochs.size(); ++k) {
    const RawEpoch epoch = receiver.epoch(0.1 * static_cast<double>(k + 1));
    const BySignal base = by_signal(plain.epochs[k]);
    for (const SignalObservation& o : epoch.observations) {
      const auto& b = base.at({o.satellite, o.code});
      const double carrier = meters(o, o.carrier_cycles - b.carrier_cycles);
      const double doppler = -meters(o, o.doppler_hz - b.doppler_hz);
      if (std::isnan(carrier)) continue;
      if (const auto before = last.find({o.satellite, o.code}); before != last.end()) {
        const double mean = 0.5 * (doppler + before->second[1]);
        worst = std::max(worst, std::abs(carrier - before->second[0] - 0.1 * mean));
      }
      last[{o.satellite, o.code}] = {carrier, doppler};
      carrier_sum += carrier * carrier;
      doppler_sum += doppler * doppler;
      ++count;
    }
  }
  REQUIRE(worst < 5e-4);  // the trapezoid's error
  REQUIRE(std::sqrt(carrier_sum / count) > 0.01);
  REQUIRE(std::sqrt(doppler_sum / count) > 0.005);
}

TEST_CASE("Noise follows the C/N0 as thermal noise does", "[sim]") {
  const Keys quiet = {"receiver.multipath.code_m=0", "receiver.multipath.carrier_m=0",
                      "receiver.tracking.slips_per_hour=0", "receiver.cn0.scatter_db=0"};
  Keys silent = quiet;
  silent.emplace_back("receiver.ideal=true");
  const SimulatedEpochs noisy = simulate_epochs(kDrive, quiet),
                        pure = simulate_epochs(kDrive, silent);
  double squares[2] = {0.0, 0.0};  // of the weak and the strong half
  int counts[2] = {0, 0};
  for (std::size_t k = 0; k < noisy.epochs.size(); ++k) {
    const BySignal base = by_signal(pure.epochs[k]);
    for (const SignalObservation& o : noisy.epochs[k].observations) {
      if (o.satellite.system != System::kGps || o.code.band != '1') continue;
      const double error = o.pseudorange_m - base.at({o.satellite, o.code}).pseudorange_m;
      const double expected = 0.3 * std::pow(10.0, (50.0 - o.cn0_dbhz) / 20.0);
      const int half = o.cn0_dbhz < 45.0 ? 0 : 1;
      squares[half] += error * error / (expected * expected);
      ++counts[half];
    }
  }
  for (int half : {0, 1}) {
    REQUIRE(counts[half] > 200);
    REQUIRE(std::sqrt(squares[half] / counts[half]) == Approx(1.0).margin(0.1));
  }
}

TEST_CASE("The ionosphere delays codes, advances carriers, and goes by the frequency", "[sim]") {
  const SimulatedEpochs run =
      simulate_epochs("duration_s: 600", {"ideal=true", "atmosphere.wave_tecu=3"});
  // Code minus carrier changes by twice the delay, which the codes of two frequencies tell.
  std::map<SatelliteId, double> first;
  double worst = 0.0, most = 0.0;
  for (const RawEpoch& epoch : run.epochs) {
    const BySignal signals = by_signal(epoch);
    for (const SignalObservation& o : epoch.observations) {
      if (o.satellite.system != System::kGps || o.code.band != '1' || o.lock_time_s < 1.0) continue;
      const SignalObservation& second = signals.at({o.satellite, {'2', 'W'}});
      const double ratio = 1575.42e6 / 1227.60e6;
      const double delay = (second.pseudorange_m - o.pseudorange_m) / (ratio * ratio - 1.0);
      const double divergence = o.pseudorange_m - meters(o, o.carrier_cycles) - 2.0 * delay;
      const auto [place, is_new] = first.try_emplace(o.satellite, divergence);
      // The antenna's turn is in the carrier: whole turns of the vehicle and parts of them.
      worst = std::max(worst, std::abs(divergence - place->second));
      most = std::max(most, delay);
      REQUIRE(delay > 0.3);
    }
  }
  REQUIRE(worst < 1.5);  // wind-up of a few cycles and no more
  REQUIRE(most > 2.0);
}

TEST_CASE("Slips: whole cycles, at the rate asked for, flagged as often as asked for", "[sim]") {
  const std::string yaml = "duration_s: 600\nroute: {standing_s: 600}\n";
  const Keys base = {"receiver.multipath.carrier_m=0", "receiver.cn0.horizon_loss_db=0",
                     "receiver.tracking.told_share=0.6"};
  Keys with = base, without = base;
  with.emplace_back("receiver.tracking.slips_per_hour=120");
  without.emplace_back("receiver.tracking.slips_per_hour=0");
  const SimulatedEpochs slipping = simulate_epochs(yaml, with),
                        steady = simulate_epochs(yaml, without);
  std::map<std::pair<SatelliteId, SignalCode>, double> offset;
  int slips = 0, told = 0, both = 0;
  double satellite_hours = 0.0;
  for (std::size_t k = 1; k < slipping.epochs.size(); ++k) {
    const BySignal other = by_signal(steady.epochs[k]);
    std::map<SatelliteId, int> hit;
    for (const SignalObservation& o : slipping.epochs[k].observations) {
      const SignalObservation& s = other.at({o.satellite, o.code});
      if (std::isnan(o.carrier_cycles)) continue;
      const double difference = o.carrier_cycles - s.carrier_cycles;
      REQUIRE(std::abs(difference - std::round(difference)) < 1e-6);
      double& before = offset[{o.satellite, o.code}];
      if (std::round(difference) != before) {
        REQUIRE(std::abs(std::round(difference) - before) <= 10.0);
        ++slips;
        ++hit[o.satellite];
        told += o.loss_of_lock ? 1 : 0;
        REQUIRE((o.lock_time_s == 0.0) == o.loss_of_lock);
        before = std::round(difference);
      }
      if (o.code.band == '1' || o.code == SignalCode{'2', 'I'}) satellite_hours += 1.0 / 3600.0;
    }
    for (const auto& [satellite, signals] : hit) both += signals == 2 ? 1 : 0;
  }
  const double events = slips - both;
  REQUIRE(events == Approx(120.0 * satellite_hours).epsilon(0.1));
  REQUIRE(told == Approx(0.6 * slips).epsilon(0.1));
  REQUIRE(both == Approx(events / 3.0).epsilon(0.2));
}

TEST_CASE("Carriers that start again may be off by half a cycle until that is resolved", "[sim]") {
  const std::string yaml =
      "duration_s: 120\nroute: {standing_s: 120}\nideal: true\n"
      "faults: [{kind: outage, from_s: 40, to_s: 45}]";
  sim::Scenario scenario = sim::load_scenario_text(yaml, "test.yaml");
  scenario.receiver.tracking.half_cycle_share = 1.0;
  const SplineMotion motion = sim::drive(scenario);
  const sim::TrueSky sky = sim::build_sky(scenario);
  const sim::FaultScript faults(scenario.faults);
  sim::Receiver receiver(scenario, motion, sky, faults);
  const SimulatedEpochs plain =
      simulate_epochs("duration_s: 120\nroute: {standing_s: 120}\nideal: true");
  int halves = 0, wholes = 0;
  for (int k = 1; k < 100; ++k) {
    const RawEpoch epoch = receiver.epoch(k);
    const BySignal base = by_signal(plain.epochs[static_cast<std::size_t>(k - 1)]);
    for (const SignalObservation& o : epoch.observations) {
      const auto other = base.find({o.satellite, o.code});
      if (k < 46 || k > 60 || other == base.end() || std::isnan(o.carrier_cycles)) continue;
      const double off =
          std::abs(std::remainder(o.carrier_cycles - other->second.carrier_cycles, 1.0));
      if (!o.half_cycle_ambiguous) {
        REQUIRE(off < 1e-5);
      } else {
        REQUIRE((off < 1e-5 || off > 0.5 - 1e-5));
        ++(off < 0.25 ? wholes : halves);
      }
    }
  }
  REQUIRE(halves > 50);
  REQUIRE(wholes > 50);
}

TEST_CASE("A clock that steps by milliseconds takes codes and, if so built, carriers along",
          "[sim]") {
  const std::string yaml = "duration_s: 200\nroute: {standing_s: 300}\nideal: true\n";
  const Keys fast = {"receiver.clock.drift_ppb=9000", "receiver.clock.oscillator=ocxo"};
  const auto run = [&](const std::string& jumps) {
    Keys keys = fast;
    keys.push_back("receiver.clock.jumps=" + jumps);
    return simulate_epochs(yaml, keys);
  };
  const SimulatedEpochs none = run("none"), code = run("code"), both = run("code_and_carrier");
  const double step_m = 1e-3 * kSpeedOfLight;
  bool stepped = false;
  for (std::size_t k = 0; k < none.epochs.size(); ++k) {
    const BySignal a = by_signal(code.epochs[k]), b = by_signal(both.epochs[k]);
    // 9 us a second from 10 us on: beyond 500 us after 54 s, and again 111 s later.
    const double t = static_cast<double>(k + 1);
    const double steps = t < 54.0 ? 0.0 : t < 166.0 ? -1.0 : -2.0;
    if (std::abs(t - 54.5) < 1.0 || std::abs(t - 165.5) < 1.0) continue;
    stepped = stepped || steps != 0.0;
    for (const SignalObservation& o : none.epochs[k].observations) {
      const auto x = a.find({o.satellite, o.code}), y = b.find({o.satellite, o.code});
      if (x == a.end() || y == b.end() || !(o.lock_time_s >= t - 2.0)) continue;
      // Reception is later by as much: satellites come and go by less than 8 m meanwhile, and the
      // clock gains 3 m.
      const double moved = 11.0 * std::abs(steps) + 1e-3;
      REQUIRE(std::abs(x->second.pseudorange_m - o.pseudorange_m - steps * step_m) < moved);
      REQUIRE(x->second.pseudorange_m == y->second.pseudorange_m);
      REQUIRE(std::abs(meters(o, x->second.carrier_cycles - o.carrier_cycles)) < moved);
      REQUIRE(std::abs(meters(o, y->second.carrier_cycles - o.carrier_cycles) - steps * step_m) <
              moved);
    }
  }
  REQUIRE(stepped);
}
