// What became of an outage: how far the position stepped when satellites came back, against the
// sigma it was told with, and how long it took to be as good as before.
#pragma once
#include <Eigen/Core>
#include <optional>

#include "core/base/gps_time.h"

namespace leonav {

class OutageMonitor {
 public:
  struct Position {
    Eigen::Vector3d p_e = Eigen::Vector3d::Zero();         // of the antenna, m
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2
  };
  struct Over {
    double lasted_s = 0.0;
    double step_m = 0.0;
    double step_sigmas = 0.0;  // of the 3D sigma before it
  };

  void reset() { *this = OutageMonitor(); }
  // An update at `time` by satellites, before and after it. Set: an outage has ended with it.
  std::optional<Over> add(GpsTime time, const Position& before, const Position& after);
  // Seconds since the outage's end, once: when the position's sigma is again at most half as large
  // again as it was before the outage.
  std::optional<double> reconverged();

 private:
  GpsTime last_, ended_;
  double sigma_m_ = 0.0;       // after the last update
  double sigma_then_m_ = 0.0;  // before the outage
  bool converging_ = false;
};

}  // namespace leonav
