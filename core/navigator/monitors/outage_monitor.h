// OutageMonitor measures what an outage cost: the step of the position when satellites came back,
// against its sigma, and the time until the position was as good as before.
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
  // Adds an update by satellites at `time`, with the position before and after. Returns a value if
  // it ended an outage.
  std::optional<Over> add(GpsTime time, const Position& before, const Position& after);
  // Returns the seconds since the outage's end, once: when the position's sigma has fallen to 1.5
  // times its value before the outage.
  std::optional<double> reconverged();

 private:
  GpsTime last_, ended_;
  double sigma_m_ = 0.0;       // after the last update
  double sigma_then_m_ = 0.0;  // before the outage
  bool converging_ = false;
};

}  // namespace leonav
