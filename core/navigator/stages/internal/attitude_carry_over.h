// AttitudeCarryOver takes the attitude from a filter before its restart and gives it back
// afterwards.
#pragma once
#include <Eigen/Geometry>

#include "core/filter/ekf.h"

namespace leonav {

// The estimated IMU errors are carried over with the attitude. Roll and pitch return with a sigma
// of at least `levelling_sigma`, the heading with twice its sigma and at least 0.1 rad.
class AttitudeCarryOver {
 public:
  // `levelling_sigma` is that of AlignmentConfig, rad. Precondition: `filter` has an attitude.
  AttitudeCarryOver(const Ekf& filter, double levelling_sigma);
  // Sets attitude and IMU errors. Precondition: `filter` is initialized at `time`, without
  // attitude.
  void give_to(Ekf* filter, GpsTime time) const;

 private:
  Eigen::Quaterniond q_eb_;
  Eigen::Vector3d sigma_rpy_;  // rad
  ImuErrors errors_;
  ImuErrorCovariance error_covariance_;
  AttitudeRandomWalk random_walk_;
};

}  // namespace leonav
