// The speed of the last seconds as the filter sees it, for an odometer, which tells of
// intervals.
#pragma once
#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <optional>

#include "core/filter/state/filter_state.h"

namespace leonav {

// Of one point of the body along the direction of travel, m/s. Allocates when constructed, not
// after.
class SpeedHistory {
 public:
  // `point_b`: from the IMU, m.
  explicit SpeedHistory(const Eigen::Vector3d& point_b)
      : point_b_(point_b), speeds_(kMaxSpeedHistory) {}

  void clear() { speeds_.clear(); }
  // The state at its time, later than the one before; after a hole of more than a tenth of a second
  // the history begins anew. `measured_rate_b`: the gyros', errors not removed, rad/s.
  void add(const FilterState& state, const Eigen::Vector3d& measured_rate_b);
  // The same at the last one's time, after an update: what has been wrong with the speed now has
  // been wrong with those before. At another time: the history begins there.
  void correct(const FilterState& state, const Eigen::Vector3d& measured_rate_b);
  // Way over (from, to], m; nullopt: not all of it is kept.
  std::optional<double> distance(GpsTime from, GpsTime to) const;
  double last() const { return speeds_.empty() ? 0.0 : speeds_.back().m_s; }

 private:
  struct Speed {
    GpsTime time;
    double m_s = 0.0;
  };
  Eigen::Vector3d point_b_;
  boost::circular_buffer<Speed> speeds_;
};

}  // namespace leonav
