// Multipath gives the errors by reflections that arrive together with a signal.
#pragma once
#include "core/gnss/measurement/look_angles.h"
#include "core/gnss/signals/satellite.h"
#include "tools/sim/scenario/lattice_noise.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Errors of one signal.
struct MultipathError {
  double code_m = 0.0, carrier_m = 0.0, doppler_m_s = 0.0;
};

// MultipathAge measures how long a static antenna's reflections of one satellite have had to
// change. The unit is s of a satellite in medium orbit; one in low orbit has moved across the sky
// within seconds.
class MultipathAge {
 public:
  // Advances to time t (s), where the satellite is at `elevation` and moves by `rates` (rad/s).
  void advance(double t, double elevation, const LookAngles& rates);
  double seconds() const { return seconds_; }
  double rate() const { return rate_; }

 private:
  bool started_ = false;
  double t_ = 0.0, seconds_ = 0.0, rate_ = 1.0;
};

// Each signal of each satellite has independent errors, correlated in time at rest and along the
// way in motion. The error of the Doppler is the rate of the carrier's.
class Multipath {
 public:
  explicit Multipath(const Scenario& scenario)
      : seed_(scenario.seed), config_(scenario.receiver.multipath) {}

  // Returns the errors. `travelled_m` and `speed_m_s` are the vehicle's; `strength` is that of the
  // place, relative to an open one.
  MultipathError error(SatelliteId satellite, std::size_t signal, double elevation,
                       const MultipathAge& age, double travelled_m, double speed_m_s,
                       double strength) const;

 private:
  std::uint64_t seed_;
  MultipathConfig config_;
};

}  // namespace leonav::sim
