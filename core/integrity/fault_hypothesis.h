// FaultHypothesis is one way in which the inputs may be faulty, and how far it may have moved the
// estimate unnoticed.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include "core/base/capacity.h"

namespace leonav {

// A fault, for instance of one satellite. The estimate without the suspect inputs is right even if
// they are faulty; the separation is the estimate with them minus that one. North, east, down.
struct FaultHypothesis {
  // That the fault is present, without having been detected, at one independent sample (risk.h).
  double probability = 0.0;
  // The separation as observed, or the threshold that a monitor holds it below. Signs do not
  // matter.
  Eigen::Vector3d separation_n = Eigen::Vector3d::Zero();  // m
  // Covariance of the separation without fault, m^2: that of the estimate without the suspect
  // inputs minus that of the estimate.
  Eigen::Matrix3d separation_covariance_n = Eigen::Matrix3d::Zero();
  double heading_separation = 0.0;           // rad
  double heading_separation_variance = 0.0;  // rad^2
};

// The hypotheses of one epoch, beside that of no fault.
using FaultHypotheses = boost::container::static_vector<FaultHypothesis, kMaxFaultHypotheses>;

}  // namespace leonav
