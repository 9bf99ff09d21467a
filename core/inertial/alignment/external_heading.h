// ExternalHeading holds a heading that was given by configuration, command or checkpoint, as long
// as it is valid.
#pragma once
#include <optional>

#include "core/inertial/strapdown/imu.h"

namespace leonav {

// A given heading holds for the place and time at which it was given. It serves one alignment.
// After that it stays valid only while the vehicle has stood still ever since: a restart in the
// middle of a drive must not turn the vehicle back into its parking position.
class ExternalHeading {
 public:
  // A heading with its uncertainty.
  struct Heading {
    double heading = 0.0;  // rad, clockwise from north
    double sigma = 0.0;    // rad
  };

  // Replaces the heading; the new one is valid for one alignment regardless of motion.
  void set(const Heading& heading);
  // Returns the heading, or nullopt if none was given or it is no longer valid.
  std::optional<Heading> get() const;
  // Marks the heading as used: from now on motion ends its validity.
  void use();
  // Removes a heading that has proved wrong.
  void forget() { heading_.reset(); }

  // Both overloads end the validity of a used heading on motion; call them with every sample and
  // every velocity.
  //
  // A mean rate over a second above `still_rate` (rad/s) is a turn. A speed beyond standing, or one
  // too uncertain to confirm standing, is a drive. A gap in the samples that cannot be filled may
  // hide either. `speed_3d`, `sigma_v` (per component) and `min_speed` are in m/s.
  void end_on_motion(const ImuSample& sample, double still_rate);
  void end_on_motion(double speed_3d, double sigma_v, double min_speed);

 private:
  static constexpr double kTurnWindow_s = 1.0;  // noise and vibration average out over this long

  std::optional<Heading> heading_;
  bool used_ = false;
  ImuSample window_;  // sum over the current second; its time is that of the last sample
};

// Returns whether an antenna of this 3D speed and 1 sigma per component, m/s, may be at rest.
bool may_be_stationary(double speed_3d, double sigma_v, double min_speed);

}  // namespace leonav
