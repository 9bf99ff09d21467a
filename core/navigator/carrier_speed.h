// How fast the antenna moves by the carriers alone, over a few seconds: the word of a witness whom
// neither the IMU nor what the filter has been told of a standstill can sway.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstddef>
#include <optional>

#include "core/gnss/carrier_follower.h"

namespace leonav {

class CarrierSpeed {
 public:
  // After each epoch with measurements; nullopt: its carriers tell nothing, and all starts anew, as
  // after a hole. Reflections make a change wrong by centimetres, but the changes between the same
  // arcs add up to no more than that.
  void add(const std::optional<AntennaChange>& change);
  // Horizontal, m/s, of the last kWindow_s; nullopt: not known for so long. `antenna_p_e`: ECEF, m,
  // for what is horizontal.
  std::optional<double> horizontal(const Eigen::Vector3d& antenna_p_e) const;

  static constexpr double kWindow_s = 4.0;

 private:
  static constexpr std::size_t kMostKept = 32;
  static constexpr double kKeptEvery_s = 0.2;
  struct Kept {
    GpsTime time;
    Eigen::Vector3d way_e = Eigen::Vector3d::Zero();  // m, since all started anew
  };
  boost::container::static_vector<Kept, kMostKept> kept_;
  Kept now_;
};

}  // namespace leonav
