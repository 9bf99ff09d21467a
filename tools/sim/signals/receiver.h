// A receiver's epochs: every satellite above the mask with code, carrier, Doppler and C/N0.
#pragma once
#include <map>

#include "core/gnss/observation.h"
#include "tools/sim/signals/signal_path.h"

namespace leonav::sim {

class Receiver {
 public:
  // All referred to must outlive it.
  Receiver(const Scenario& scenario, const SplineMotion& motion, const TrueSky& sky);

  // The epoch that the receiver's clock stamps `t_tag` seconds from the start. In order of time.
  RawEpoch epoch(double t_tag);
  double wind_up_resets() const { return 0.0; }

 private:
  struct Tracking;  // of one satellite
  void observe(std::size_t index, double t, const Eigen::Vector3d& tide_e, RawEpoch* raw);
  double common_range_m(const TrueSatellite& satellite, double t, const Eigen::Vector3d& tide_e,
                        double* tecu) const;

  struct Track {
    bool tracked = false;
    double wind_up = 0.0, locked_since = 0.0;
    double cycles[2] = {0.0, 0.0};
    GaussianGenerator random{0};
  };

  const Scenario& scenario_;
  const SplineMotion& motion_;
  const TrueSky& sky_;
  Atmosphere atmosphere_;
  ClockTable clock_;
  std::array<double, kSystemCount> system_offset_m_;
  std::vector<Track> tracks_;  // by satellite of the sky
};

}  // namespace leonav::sim
