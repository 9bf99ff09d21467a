// OdometerAiding turns odometer increments into one mean speed for each instant of the constraints.
//
//   mean = distance / time,  variance = pieces (pulse / time)^2 / 6,  change = v_filter(now) - mean
//   of v_filter
//
// An increment ends at any time, so that its mean is not the speed at the instant; the filter's own
// speeds give the difference. Units: m, s, m/s, positive forward.
#pragma once
#include <span>

#include "core/filter/ekf.h"
#include "core/inertial/strapdown/odometer.h"

namespace leonav {

// OdometerAiding holds the increments that wait for an instant. Allocates when constructed, not
// after.
class OdometerAiding {
 public:
  explicit OdometerAiding(const MotionConstraintConfig& config)
      : config_(config), speeds_(config.odometer_point_b), waiting_(kMaxOdometerBlock) {}

  // Adds increments in order of time. Without room the oldest are dropped.
  void add(std::span<const OdometerIncrement> increments);
  // Removes all increments and speeds, but not the fact that an odometer exists: after this, time
  // may begin anew.
  void reset();
  bool received() const { return received_; }  // an increment was ever received
  // Returns the history into which the filter's prediction writes its speeds, corrected to the
  // filter's present state; nullptr if no odometer needs it.
  SpeedHistory* follow(const Ekf& ekf);
  // Takes the increments that end by `now` and were not taken before, as far as the speed history
  // reaches back.
  //
  // An increment without a sign gets the sign of the filter's speed, whose sigma (m/s) must be
  // small enough for that.
  OdometerSpeed take(GpsTime now, double speed_sigma);
  // Returns whether a wheel turned in the last second, as far as increments were taken.
  bool moved(GpsTime now) const;

 private:
  MotionConstraintConfig config_;
  SpeedHistory speeds_;
  boost::circular_buffer<OdometerIncrement> waiting_;
  GpsTime last_moved_;
  bool received_ = false;
};

}  // namespace leonav
