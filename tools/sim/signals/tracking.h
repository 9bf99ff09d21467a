// Tracking simulates how a receiver tracks one satellite's signals: acquisition, loss, cycles,
// slips.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/gnss/signals/satellite.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/street/cycle_slip.h"

namespace leonav::sim {

// The signals of a satellite as they arrive at one epoch.
struct Arrival {
  bool present = false;
  std::array<double, kTrackedSignals> cn0_dbhz{};
  double loss_db = 0.0;      // of the first signal, relative to the zenith
  double slip_factor = 1.0;  // of the place
  bool direct = true;        // ORACLE
  unsigned route = 0;        // way of the signal; another one breaks the carrier
  std::array<CycleSlip, kTrackedSignals> slips;  // since the epoch before, by the street
};

// The state of one signal.
struct SignalTrack {
  bool code = false, carrier = false;  // measured
  double cycles = 0.0;                 // whole and half cycles to be added to the carrier
  double locked_since = 0.0;           // as the receiver reports
  bool loss_of_lock = false, half_cycle_ambiguous = false;
};

// Tracking is stepped epoch by epoch.
class Tracking {
 public:
  Tracking(const Scenario& scenario, SatelliteId satellite);

  // Steps to the next epoch, in order of time. At the first one the receiver has been running for a
  // while.
  void step(double t, const Arrival& arrival);
  const SignalTrack& signal(std::size_t i) const { return signals_[i].now; }
  void reset();  // all tracks are lost, as by a restart

 private:
  struct Signal {
    SignalTrack now;
    bool acquiring = false;
    double acquired_at = 0.0;  // code from here on
    double carrier_at = 0.0;   // carrier from here on
    double resolved_at = 0.0;  // time at which the half cycle is resolved
    double half = 0.0;         // half cycle that is wrong until then
  };
  void follow(std::size_t i, double t, const Arrival& arrival);
  void start_carrier(std::size_t i, double t, bool direct);
  void slip(double t, const Arrival& arrival, double interval_s);
  void apply(std::size_t i, double t, const CycleSlip& slip);

  TrackingConfig config_;
  std::uint64_t seed_;
  std::size_t place_;
  std::array<Signal, kTrackedSignals> signals_;
  bool running_ = false;
  double last_t_ = 0.0;
  unsigned route_ = 0;
};

}  // namespace leonav::sim
