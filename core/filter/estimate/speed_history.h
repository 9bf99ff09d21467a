// SpeedHistory keeps the filter's speed over the last seconds, because an odometer measures
// intervals.
#pragma once
#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <optional>

#include "core/filter/state/filter_state.h"

namespace leonav {

// The speed is that of one point of the body along the direction of travel, m/s. Allocates when
// constructed, not after.
class SpeedHistory {
 public:
  // `point_b`: from the IMU to the point, body axes, m.
  explicit SpeedHistory(const Eigen::Vector3d& point_b)
      : point_b_(point_b), speeds_(kMaxSpeedHistory) {}

  void clear() { speeds_.clear(); }
  // Adds a state, which must be later than the one before; after a gap of more than 0.1 s the
  // history begins anew. `measured_rate_b`: of the gyros, errors not removed, rad/s.
  void add(const FilterState& state, const Eigen::Vector3d& measured_rate_b);
  // Shifts the history by what an update has changed the last speed by: the error now was there
  // before. A state of another time begins the history anew.
  void correct(const FilterState& state, const Eigen::Vector3d& measured_rate_b);
  // Returns the distance over (from, to], m; nullopt if the history does not cover it.
  std::optional<double> distance(GpsTime from, GpsTime to) const;
  // Returns the last speed, m/s.
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
