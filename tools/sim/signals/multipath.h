// Errors by reflections that arrive together with a signal.
#pragma once
#include "core/gnss/look_angles.h"
#include "core/gnss/satellite.h"
#include "tools/sim/scenario/lattice_noise.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

struct MultipathError {
  double code_m = 0.0, carrier_m = 0.0, doppler_m_s = 0.0;
};

// How long a standing antenna's reflections of one satellite have had to change: s, of a satellite
// in medium orbit. One in low orbit is elsewhere in the sky within seconds.
class MultipathAge {
 public:
  // To time t (s), where the satellite stands at `elevation` and moves by `rates` (rad/s).
  void advance(double t, double elevation, const LookAngles& rates);
  double seconds() const { return seconds_; }
  double rate() const { return rate_; }

 private:
  bool started_ = false;
  double t_ = 0.0, seconds_ = 0.0, rate_ = 1.0;
};

// Each signal of each satellite has its own course of errors, correlated in time while the vehicle
// stands and along the way while it goes. That on the Doppler is the rate of the carrier's.
class Multipath {
 public:
  explicit Multipath(const Scenario& scenario)
      : seed_(scenario.seed), config_(scenario.receiver.multipath) {}

  // `travelled_m` and `speed_m_s` of the vehicle; `strength`: of the place, against an open
  // one.
  MultipathError error(SatelliteId satellite, std::size_t signal, double elevation,
                       const MultipathAge& age, double travelled_m, double speed_m_s,
                       double strength) const;

 private:
  std::uint64_t seed_;
  MultipathConfig config_;
};

}  // namespace leonav::sim
