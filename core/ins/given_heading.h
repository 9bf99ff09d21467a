// A heading told from outside, by configuration or command, and how long it may be believed.
#pragma once
#include <optional>

#include "core/ins/imu.h"

namespace leonav {

// What was told is true where and when it was told. It is good for one alignment; after that it is
// good again only while the vehicle has demonstrably stood still ever since: a restart in the
// middle of a drive must not turn the vehicle back into its parking space.
class GivenHeading {
 public:
  struct Heading {
    double heading = 0.0;  // rad, clockwise from north
    double sigma = 0.0;    // rad
  };

  // Replaces what was told before, and is good once more.
  void tell(const Heading& heading);
  // nullopt: nothing told, or no longer true.
  std::optional<Heading> get() const;
  // It has given an attitude.
  void use();
  // It has proved wrong.
  void forget() { heading_.reset(); }

  // To be told of all motion after that. A mean rate over a second above `still_rate` (rad/s) is a
  // turn; a speed beyond standing, or one so uncertain that it cannot vouch for standing, is a
  // drive; a hole in the samples that cannot be bridged may hide either. `speed_3d`, `sigma_v` and
  // `min_speed` in m/s.
  void watch(const ImuSample& sample, double still_rate);
  void watch(double speed_3d, double sigma_v, double min_speed);

 private:
  static constexpr double kTurnWindow_s = 1.0;  // noise and vibration average out over so long

  std::optional<Heading> heading_;
  bool used_ = false;
  ImuSample window_;  // the current second's sum; its time is that of the last sample
};

// Whether an antenna of this speed (3D) and uncertainty (per component), m/s, may stand.
bool may_stand(double speed_3d, double sigma_v, double min_speed);

}  // namespace leonav
