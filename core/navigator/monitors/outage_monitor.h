// OutageMonitor measures how far the position stepped after an outage, and how long it took to
// converge again.
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>

#include "core/base/gps_time.h"

namespace leonav {

// An outage is an interval of 5 s or more without an update by satellites that is also half as long
// again as the shorter of the two intervals before: a receiver may send epochs every 30 s. Before
// two intervals are known there is none. Its step is compared with the sigma that the filter had
// before the update.
class OutageMonitor {
 public:
  // An estimate of the antenna's position.
  struct Position {
    Eigen::Vector3d p_e = Eigen::Vector3d::Zero();         // m, ECEF
    Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // m^2, ECEF
  };
  // The end of an outage.
  struct Over {
    double lasted_s = 0.0;
    double step_m = 0.0;       // change of the position by the first update
    double step_sigmas = 0.0;  // step over the 3D sigma before that update
  };

  void reset() { *this = OutageMonitor(); }
  // Adds an update by satellites with the positions before and after it. Returns the outage that
  // has ended with it, if there was one.
  std::optional<Over> add(GpsTime time, const Position& before, const Position& after);
  // Returns once the seconds from the outage's end until the position's sigma is again at most 1.5
  // times that before the outage; else nullopt.
  std::optional<double> reconverged();

 private:
  GpsTime last_, ended_;
  std::array<double, 2> last_intervals_s_{};  // between updates; 0: not known yet
  double sigma_m_ = 0.0;                      // 3D sigma after the last update
  double sigma_then_m_ = 0.0;                 // 3D sigma before the outage
  bool converging_ = false;  // since an outage the sigma has not become as small as before
};

}  // namespace leonav
