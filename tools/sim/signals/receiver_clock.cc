#include "tools/sim/signals/receiver_clock.h"

#include <cmath>

#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {
namespace {

constexpr double kMillisecond = 1e-3;

// White and random-walk frequency noise follow from h0 and h-2 in Brown and Hwang, Introduction to
// Random Signals and Applied Kalman Filtering, 4th ed., table 9.2: sqrt(h0 / 2), sqrt(2 pi^2 h-2).
ClockErrors oscillator_errors(const ReceiverClockConfig& config) {
  ClockErrors errors;
  errors.offset_s = config.offset_s;
  errors.drift = config.drift;
  const auto from = [&errors](double h0, double h_2) {
    errors.phase_walk_s = std::sqrt(0.5 * h0);
    errors.drift_walk = std::sqrt(19.739208802178716 * h_2);
  };
  if (config.oscillator == Oscillator::kTcxo) from(2e-19, 2e-20);
  if (config.oscillator == Oscillator::kOcxo) from(2e-25, 6e-25);
  return errors;
}

}  // namespace

ReceiverClock::ReceiverClock(const Scenario& scenario)
    : config_(scenario.receiver.clock),
      oscillator_(-10.0, scenario.duration_s + 10.0, 1.0, oscillator_errors(config_),
                  random_stream(scenario.seed, "receiver clock")) {
  for (const System system : kSystems) {
    ClockErrors walk;
    GaussianGenerator random = random_stream(scenario.seed, "time base", index_of(system));
    const double offset_m = config_.time_base_sigma_m * random.draw();
    if (system != System::kGps) {  // the reference for the others
      walk.offset_s = offset_m;
      walk.phase_walk_s = config_.time_base_walk_m_per_sqrt_s;
    }
    time_bases_.emplace_back(-60.0, scenario.duration_s + 60.0, 60.0, walk, random);
  }
}

ClockReading ReceiverClock::read(double t_tag) {
  const auto offset_at = [&](double t) { return oscillator_.at(t).offset_s + steps_s_; };
  // Within a millisecond of the instant is accurate enough to decide.
  while (config_.jumps != ClockJumps::kNone && std::abs(offset_at(t_tag)) > config_.jump_limit_s) {
    steps_s_ -= std::copysign(kMillisecond, offset_at(t_tag));
  }
  ClockReading reading;
  reading.t = t_tag;
  // Each round gains a factor of the drift, 1e-5 at most.
  for (int i = 0; i < 4; ++i) reading.t = t_tag - offset_at(reading.t);
  const ClockTable::Value oscillator = oscillator_.at(reading.t);
  reading.code_s = oscillator.offset_s + steps_s_;
  reading.carrier_s =
      config_.jumps == ClockJumps::kCodeAndCarrier ? reading.code_s : oscillator.offset_s;
  reading.drift = oscillator.drift;
  return reading;
}

ClockTable::Value ReceiverClock::time_base_m(System system, double t) const {
  return time_bases_[index_of(system)].at(t);
}

}  // namespace leonav::sim
