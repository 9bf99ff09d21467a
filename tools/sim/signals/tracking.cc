#include "tools/sim/signals/tracking.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {

Tracking::Tracking(const Scenario& scenario, SatelliteId satellite)
    : config_(scenario.receiver.tracking),
      seed_(scenario.seed),
      place_(table_index_of(satellite)) {}

void Tracking::reset() {
  for (Signal& signal : signals_) signal = Signal();
}

void Tracking::step(double t, const Arrival& arrival) {
  const double interval_s = running_ ? t - last_t_ : 0.0;
  const bool other_route = arrival.present && arrival.route != route_;
  if (arrival.present) route_ = arrival.route;
  for (std::size_t i = 0; i < kTrackedSignals; ++i) {
    if (other_route) {
      signals_[i].now.carrier = false;
      signals_[i].carrier_at = t + config_.carrier_s;
    }
    follow(i, t, arrival);
  }
  if (arrival.present) slip(t, arrival, interval_s);
  for (std::size_t i = 0; i < kTrackedSignals; ++i) apply(i, t, arrival.slips[i]);
  running_ = true;
  last_t_ = t;
}

void Tracking::follow(std::size_t i, double t, const Arrival& arrival) {
  Signal& signal = signals_[i];
  signal.now.loss_of_lock = false;
  const double needed = signal.now.code ? config_.hold_dbhz : config_.acquire_dbhz;
  if (!arrival.present || arrival.cn0_dbhz[i] < needed) {
    signal = Signal();
    return;
  }
  if (!signal.acquiring) {
    signal.acquiring = true;
    signal.acquired_at = running_ ? t + config_.acquire_s : t;
    signal.carrier_at = running_ ? signal.acquired_at + config_.carrier_s : t;
  }
  constexpr double kRounding_s = 1e-3;  // the receiver's clock against its stamps
  signal.now.code = t >= signal.acquired_at - kRounding_s;
  if (!signal.now.code || t < signal.carrier_at - kRounding_s) return;
  if (!signal.now.carrier) start_carrier(i, t, arrival.direct);
  if (signal.now.half_cycle_ambiguous && t >= signal.resolved_at - kRounding_s) {
    signal.now.half_cycle_ambiguous = false;
    signal.now.cycles -= signal.half;
  }
}

bool oracle() {
  static const bool on = std::getenv("LEONAV_ORACLE") != nullptr;
  return on;
}

void Tracking::start_carrier(std::size_t i, double t, bool direct) {
  Signal& signal = signals_[i];
  GaussianGenerator random =
      random_stream(seed_, "carrier", instant_number(signal_number(place_, i), t));
  signal.now.carrier = true;
  signal.now.loss_of_lock = running_;
  signal.now.locked_since = t;
  signal.now.cycles = std::round(1e5 * random.draw());
  const double ambiguous = random.uniform(), off = random.uniform();
  signal.now.half_cycle_ambiguous = running_ && ambiguous <= config_.half_cycle_share;
  if (oracle()) {
    signal.now.half_cycle_ambiguous = false;
    if (direct)
      signal.now.cycles = 0.0;
    else
      signal.now.cycles += 1e8;
  }
  if (!signal.now.half_cycle_ambiguous) return;
  signal.resolved_at = t + config_.half_cycle_s;
  signal.half = off <= 0.5 ? 0.5 : 0.0;
  signal.now.cycles += signal.half;
}

// A slip affects either signal or both, with equal probability; a weaker signal slips more often.
void Tracking::slip(double t, const Arrival& arrival, double interval_s) {
  if (config_.slips_per_hour == 0.0) return;
  GaussianGenerator random =
      random_stream(seed_, "slip", instant_number(signal_number(place_, 0), t));
  const double rate = config_.slips_per_hour / 3600.0 * arrival.slip_factor *
                      std::pow(10.0, 0.1 * std::max(0.0, arrival.loss_db));
  const bool slips = random.uniform() < 1.0 - std::exp(-rate * interval_s);
  const bool told = random.uniform() <= config_.flagged_share;
  const double which = random.uniform();
  for (std::size_t i = 0; i < kTrackedSignals; ++i) {
    const double size = std::ceil(random.uniform() * config_.max_slip_cycles);
    const double sign = random.uniform() <= 0.5 ? -1.0 : 1.0;
    const bool hit = i == 0 ? which <= 2.0 / 3.0 : which > 1.0 / 3.0;
    if (slips && hit) apply(i, t, {sign * size, told});
  }
}

void Tracking::apply(std::size_t i, double t, const CycleSlip& slip) {
  SignalTrack& track = signals_[i].now;
  if (oracle() || slip.cycles == 0.0 || !track.carrier || track.locked_since == t) return;
  track.cycles += slip.cycles;
  if (!slip.told) return;
  track.loss_of_lock = true;
  track.locked_since = t;
}

}  // namespace leonav::sim
