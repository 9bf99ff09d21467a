// From an odometer's increments to its word at the instants of constraints.
#pragma once
#include <span>

#include "core/ekf/ekf.h"
#include "core/ins/odometer.h"

namespace leonav {

// Allocates when constructed, not after.
class OdometerAid {
 public:
  explicit OdometerAid(const MotionConstraintConfig& config)
      : config_(config), speeds_(config.odometer_point_b), waiting_(kMaxOdometerBlock) {}

  // In order of time. Without room the oldest go.
  void add(std::span<const OdometerIncrement> increments);
  // Of what came before nothing is left but that there is an odometer: time may begin anew.
  void reset();
  bool heard() const { return heard_; }  // of an increment, ever
  // Where the filter's prediction leaves its speeds, from the filter as it is on; nullptr: nobody
  // asks for them.
  SpeedHistory* follow(const Ekf& ekf);
  // Of the increments that end by `now` and have not been taken, as far as the speeds reach back.
  // An increment without a sign has that of the filter's speed, whose sigma (m/s) must allow one.
  OdometerSpeed take(GpsTime now, double speed_sigma);
  // A wheel turned in the last second, as far as increments were taken.
  bool moved(GpsTime now) const;

 private:
  MotionConstraintConfig config_;
  SpeedHistory speeds_;
  boost::circular_buffer<OdometerIncrement> waiting_;
  GpsTime last_moved_;
  bool heard_ = false;
};

}  // namespace leonav
