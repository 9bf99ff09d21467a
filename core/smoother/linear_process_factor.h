// LinearProcessFactor is a process factor linearized at the present estimates, to first order in
// their errors. The prior of the window is linearized here in the same way.
#pragma once
#include <Eigen/Core>

#include "core/smoother/window.h"

namespace leonav {

// AttitudeJacobian turns an error of the estimate into a change of difference(estimate,
// linearized_at).
//
// All rows are the identity except those of the attitude, whose differences are rotation vectors:
//   log(exp([error x]) C) = log(C) + J^-1 error,
// with J the left Jacobian of SO(3) (Barfoot, State Estimation for Robotics, 2017, 7.1.5).
struct AttitudeJacobian {
  Eigen::Index index = -1;  // of the attitude among the active states; -1: not active
  Eigen::Matrix3d of_error = Eigen::Matrix3d::Identity();  // J^-1
  Eigen::Matrix3d to_error = Eigen::Matrix3d::Identity();  // J
};
// Returns J and its inverse for difference(estimate, linearized_at).
AttitudeJacobian attitude_jacobian(const ActiveStates& active, const FilterState& estimate,
                                   const FilterState& linearized_at);

// error_k = F error_(k-1) - offset + w,  w ~ N, with the errors of both keyframes' estimates in
// active states.
struct LinearProcessFactor {
  EkfCovariance F;
  EkfCovariance noise;
  EkfCorrection offset;
};
// Linearizes the process factor of `keyframe`, which follows `before`, at both estimates.
void linearize_process_factor(const Keyframe& before, const Keyframe& keyframe,
                              LinearProcessFactor* process_factor);

// Adds the information that motion constraints after keyframe `before` give about it, if there is
// any.
//
// The cost added is 0.5 e^T information e - gradient^T e, with e the error of its estimate.
void add_process_information(const Keyframe& before, const ProcessFactor& process_factor,
                             EkfCovariance* information, EkfCorrection* gradient);

// Returns the prior of the window's first keyframe as 0.5 e^T information e - gradient^T e of its
// error e.
void linearize_prior(const Window& window, EkfCovariance* information, EkfCorrection* gradient);

}  // namespace leonav
