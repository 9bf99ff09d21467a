// ReceiverConfig configures the simulated receiver and its antenna.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "core/gnss/signals/satellite.h"
#include "daemon/config/config_reader.h"

namespace leonav::sim {

// Signals of a satellite that the receiver tracks.
inline constexpr std::size_t kTrackedSignals = 2;

// 1 sigma on one frequency at the C/N0 of the zenith; it grows as the C/N0 falls.
struct NoiseConfig {
  double code_m = 0.3, carrier_m = 0.002, doppler_m_s = 0.03;
};

enum class Oscillator { kIdeal, kOcxo, kTcxo };
enum class ClockJumps { kNone, kCodeAndCarrier, kCode };

// The receiver's clock.
struct ReceiverClockConfig {
  Oscillator oscillator = Oscillator::kTcxo;
  double offset_s = 1e-5, drift = 1e-8;  // at the start
  ClockJumps jumps = ClockJumps::kNone;  // by a millisecond; of which observables
  double jump_limit_s = 5e-4;            // an offset beyond this causes a jump
  // Offset of each system's time and receiver delay against GPS, with its random walk.
  double time_base_sigma_m = 5.0, time_base_walk_m_per_sqrt_s = 0.1 / 60.0;
};

// Signal strength.
struct Cn0Config {
  std::array<double, kSystemCount> zenith_dbhz = {50.0, 50.0, 49.0, 52.0};  // first signal
  double second_signal_db = -4.0;  // second minus first signal of a satellite
  double horizon_loss_db = 14.0;   // antenna and path, relative to the zenith
  double scatter_db = 0.5;         // 1 sigma, white
};

// Acquisition, loss of lock and cycle slips.
struct TrackingConfig {
  double acquire_dbhz = 29.0;   // needed to begin
  double hold_dbhz = 24.0;      // needed to continue
  double acquire_s = 1.0;       // from the signal to its code
  double carrier_s = 1.0;       // from the code to its carrier
  double slips_per_hour = 1.0;  // of a satellite at the zenith's C/N0; ten times at 10 dB less
  double flagged_share = 0.7;   // share of slips with flag and lock time
  int max_slip_cycles = 10;
  double half_cycle_share = 0.3;  // share of the carriers that start again
  double half_cycle_s = 5.0;      // until it is resolved
};

// Multipath errors of reflections that arrive with the signal, correlated in time and along the
// way.
struct MultipathConfig {
  double code_m = 0.3, carrier_m = 0.003;  // 1 sigma at the horizon of an open place
  double elevation = 0.4992;               // rad over which they fall by a factor e
  double time_s = 60.0, length_m = 5.0;    // correlation time and length
};

// Settings of the receiver.
struct ReceiverConfig {
  bool ideal = false;  // no noise, multipath, slips or half cycles
  double interval_s = 1.0;
  Eigen::Vector3d lever_arm_b = {0.4, -0.2, -1.1};
  double elevation_mask = 0.0873;  // rad
  double gnss_latency_s = 0.05;
  std::array<NoiseConfig, kSystemCount> noise;
  ReceiverClockConfig clock;
  Cn0Config cn0;
  TrackingConfig tracking;
  MultipathConfig multipath;
};

void read_receiver(ConfigReader& group, ReceiverConfig* receiver);

// Removes all errors, as `ideal` requires.
void remove_errors(ReceiverConfig* receiver);

}  // namespace leonav::sim
