// A scenario's epochs without IMU, products and log.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/gnss/signals/band_plan.h"
#include "tools/sim/route/drive.h"
#include "tools/sim/scenario/scenario_yaml.h"
#include "tools/sim/signals/receiver.h"

namespace leonav::test {

using Keys = std::vector<std::string>;

struct SimulatedEpochs {
  sim::Scenario scenario;
  std::vector<RawEpoch> epochs;
};

inline SimulatedEpochs simulate_epochs(const std::string& yaml, const Keys& overrides = {}) {
  SimulatedEpochs run{sim::load_scenario_text(yaml, "test.yaml", overrides), {}};
  const SplineMotion motion = sim::drive(run.scenario);
  const sim::TrueSky sky = sim::build_sky(run.scenario);
  const sim::FaultScript faults(run.scenario.faults);
  sim::Receiver receiver(run.scenario, motion, sky, faults);
  const double interval_s = run.scenario.receiver.interval_s;
  for (int k = 1; k * interval_s < motion.duration_s() - 1.0; ++k) {
    run.epochs.push_back(receiver.epoch(k * interval_s));
  }
  return run;
}

// By satellite and signal, what an epoch has.
using BySignal = std::map<std::pair<SatelliteId, SignalCode>, SignalObservation>;
inline BySignal by_signal(const RawEpoch& epoch) {
  BySignal result;
  for (const SignalObservation& o : epoch.observations) result[{o.satellite, o.code}] = o;
  return result;
}

inline bool same(double a, double b) { return a == b || (a != a && b != b); }
inline bool same(const SignalObservation& a, const SignalObservation& b) {
  return a.satellite == b.satellite && a.code == b.code && same(a.pseudorange_m, b.pseudorange_m) &&
         same(a.carrier_cycles, b.carrier_cycles) && same(a.doppler_hz, b.doppler_hz) &&
         same(a.cn0_dbhz, b.cn0_dbhz) && same(a.lock_time_s, b.lock_time_s) &&
         a.loss_of_lock == b.loss_of_lock && a.half_cycle_ambiguous == b.half_cycle_ambiguous;
}
inline bool same(const RawEpoch& a, const RawEpoch& b) {
  if (a.time != b.time || a.observations.size() != b.observations.size()) return false;
  for (std::size_t i = 0; i < a.observations.size(); ++i) {
    if (!same(a.observations[i], b.observations[i])) return false;
  }
  return true;
}

inline double meters(const SignalObservation& o, double cycles) {
  return cycles * BandPlan().wavelength_m(o.satellite.system, o.code.band);
}

}  // namespace leonav::test
