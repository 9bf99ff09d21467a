// A link and the window's prior about where the estimates are now, first order in their errors.
#pragma once
#include <Eigen/Core>

#include "core/smoother/window.h"

namespace leonav {

// Rows that turn an error of the estimate into a change of difference(estimate, linearized at):
// the identity but for the attitude, whose differences are rotation vectors. J^-1 of
//   log(exp([error x]) C) = log(C) + J^-1 error
// and J itself (left Jacobian of SO(3), Barfoot, State Estimation for Robotics, 2017, 7.1.5).
struct AttitudeChange {
  Eigen::Index place = -1;  // of the attitude among the active states; -1: not active
  Eigen::Matrix3d of_error = Eigen::Matrix3d::Identity();  // J^-1
  Eigen::Matrix3d to_error = Eigen::Matrix3d::Identity();  // J
};
AttitudeChange attitude_change(const ActiveStates& active, const FilterState& estimate,
                               const FilterState& linearized_at);

// error_k = F error_(k-1) - offset + w,  w ~ N: errors of both keyframes' estimates, active states.
struct LinearLink {
  EkfCovariance F;
  EkfCovariance noise;
  EkfCorrection offset;
};
void linearize_link(const Keyframe& before, const Keyframe& keyframe, LinearLink* link);

// What the link to the next keyframe tells of the one before beyond the process, if it is informed:
// adds it to 0.5 e^T information e - gradient^T e of that keyframe's error e.
void add_link_information(const Keyframe& before, const KeyframeLink& link,
                          EkfCovariance* information, EkfCorrection* gradient);

// The prior of the window's first keyframe: 0.5 e^T information e - gradient^T e of its error e.
void linearize_prior(const Window& window, EkfCovariance* information, EkfCorrection* gradient);

}  // namespace leonav
