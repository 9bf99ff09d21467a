#include "drivers/rtcm3/msm_observations.h"

#include <cmath>
#include <limits>

#include "drivers/rtcm3/msm_signal.h"

namespace leonav {
namespace {

constexpr double kMetresPerMillisecond = kSpeedOfLight / 1e3;

// Bounds on what a receiver on or near the Earth can measure, with a clock error of tens of
// milliseconds.
constexpr double kMinPseudorange = 1e6;  // m
constexpr double kMaxPseudorange = 1e8;  // m
constexpr double kMaxCarrier = 1e10;     // cycles
constexpr double kMaxDoppler = 1e5;      // Hz

// Returns the sum of a rough and a fine part in metres; whole numbers keep it exact until the one
// product at the end. The fine unit is 2^-`fine_power` ms.
double metres(std::int32_t rough, std::int32_t fine, int fine_power) {
  constexpr int kRoughPower = 10;
  const std::int64_t units =
      std::int64_t{rough} * (std::int64_t{1} << (fine_power - kRoughPower)) + fine;
  return std::ldexp(static_cast<double>(units), -fine_power) * kMetresPerMillisecond;
}

}  // namespace

void MsmObservations::add(const MsmMessage& message, GpsTime time,
                          std::vector<SignalObservation>* signals) {
  for (const MsmCell& cell : message.cells) {
    SignalObservation observation;
    if (!decode(message, cell, time, &observation)) continue;
    signals->push_back(observation);
    ++counters_.measurements;
  }
}

// No lock is as old as what is remembered.
void MsmObservations::interrupt_carriers() {
  first_lock_.least_lock_ms = std::numeric_limits<std::int64_t>::max();
  for (auto& [signal, state] : states_) state.lock.least_lock_ms = first_lock_.least_lock_ms;
}

MsmObservations::SignalState& MsmObservations::state_of(SatelliteId satellite, std::size_t signal) {
  return states_.try_emplace({satellite, signal}, SignalState{GpsTime(), first_lock_})
      .first->second;
}

double MsmObservations::checked(double value, double low, double high) {
  if (std::isfinite(value) && value >= low && value <= high) return value;
  ++counters_.bad_value;
  return kNotMeasured;
}

bool MsmObservations::decode(const MsmMessage& message, const MsmCell& cell, GpsTime time,
                             SignalObservation* observation) {
  const System system = *message.header.type.system;
  const MsmSatellite& satellite = message.satellites[cell.satellite];
  observation->satellite = {system, satellite.number};
  if (!is_valid(observation->satellite) || satellite.number >= kSatellites) {
    ++counters_.bad_satellite;
    return false;
  }
  const std::optional<SignalCode> code = signal_from_msm(system, cell.signal);
  if (!code || wavelength_m(system, code->band) <= 0.0) {
    ++counters_.unknown_signal;
    return false;
  }
  observation->code = *code;
  SignalState& state = state_of(observation->satellite, cell.signal);
  if (state.seen == time) {
    ++counters_.duplicates;
    return false;
  }
  state.seen = time;

  const double wavelength = wavelength_m(system, code->band);
  if (satellite.rough_range && cell.fine_range) {
    observation->pseudorange_m = checked(metres(*satellite.rough_range, *cell.fine_range, 29),
                                         kMinPseudorange, kMaxPseudorange);
  }
  if (satellite.rough_range && cell.fine_phase) {
    observation->carrier_cycles =
        checked(metres(*satellite.rough_range, *cell.fine_phase, 31) / wavelength, -kMaxCarrier,
                kMaxCarrier);
  }
  if (satellite.rough_rate && cell.fine_rate) {
    constexpr int kFineRatePerMetre = 10'000;
    const double rate =
        (std::int64_t{*satellite.rough_rate} * kFineRatePerMetre + *cell.fine_rate) /
        static_cast<double>(kFineRatePerMetre);
    observation->doppler_hz = checked(-rate / wavelength, -kMaxDoppler, kMaxDoppler);
  }
  if (cell.cn0 != 0) observation->cn0_dbhz = cell.cn0 / 16.0;
  if (std::isfinite(observation->carrier_cycles)) {
    observation->lock_time_s = static_cast<double>(cell.least_lock_ms) / 1e3;
    observation->half_cycle_ambiguous = cell.half_cycle_ambiguous;
    const MsmLock now{time, cell.least_lock_ms};
    observation->loss_of_lock = lock_was_lost(state.lock, now);
    state.lock = now;
  }
  if (std::isnan(observation->pseudorange_m) && std::isnan(observation->carrier_cycles) &&
      std::isnan(observation->doppler_hz)) {
    ++counters_.empty;
    return false;
  }
  return true;
}

}  // namespace leonav
