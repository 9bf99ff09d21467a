// LinearProcessFactor is a process factor linearized at the present estimates, to first order in
// their errors. The prior of the window is linearized here in the same way.
#pragma once
#include <Eigen/Core>

#include "core/smoother/window.h"

namespace leonav {

// These multiply three rows or columns of a matrix by J, in place.
template <typename Matrix>
void rows_times(const Eigen::Matrix3d& J, Eigen::Index first, Matrix* matrix) {
  for (Eigen::Index j = 0; j < matrix->cols(); ++j)
    matrix->template block<3, 1>(first, j) = (J * matrix->template block<3, 1>(first, j)).eval();
}
template <typename Matrix>
void columns_times(const Eigen::Matrix3d& J, Eigen::Index first, Matrix* matrix) {
  for (Eigen::Index i = 0; i < matrix->rows(); ++i)
    matrix->template block<1, 3>(i, first) = (matrix->template block<1, 3>(i, first) * J).eval();
}

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
AttitudeJacobian attitude_jacobian(const ActiveStates& active, const CoreState& estimate,
                                   const CoreState& linearized_at);

// Turns F and the noise of a process factor, which hold for differences from where it was
// linearized, into those of errors of the estimates, in place: `before` and `now` are the Jacobians
// of both keyframes.
template <typename Matrix>
void turn_to_errors(const AttitudeJacobian& before, const AttitudeJacobian& now, Matrix* F,
                    Matrix* noise) {
  if (before.index >= 0) columns_times(before.of_error, before.index, F);
  if (now.index < 0) return;
  rows_times(now.to_error, now.index, F);
  rows_times(now.to_error, now.index, noise);
  columns_times(now.to_error.transpose(), now.index, noise);
}

// Turns information and gradient about a difference from where they were linearized into those
// about the error of the estimate, in place; `moved` is the difference of the estimate.
template <typename Matrix, typename Vector>
void turn_to_errors(const AttitudeJacobian& change, const EkfCorrection& moved, Matrix* information,
                    Vector* gradient) {
  gradient->noalias() -= *information * moved;
  if (change.index < 0) return;
  rows_times(change.of_error.transpose(), change.index, information);
  columns_times(change.of_error, change.index, information);
  gradient->template segment<3>(change.index) =
      (change.of_error.transpose() * gradient->template segment<3>(change.index)).eval();
}

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

// Adds the information that motion constraints and joined arcs after keyframe `before` give about
// it, if there is any.
//
// The cost added is 0.5 e^T information e - gradient^T e, with e the error of its estimate.
void add_process_information(const Keyframe& before, const ProcessFactor& process_factor,
                             EkfCovariance* information, EkfCorrection* gradient);

// Returns the prior of the window's first keyframe as 0.5 e^T information e - gradient^T e of its
// error e.
void linearize_prior(const Window& window, EkfCovariance* information, EkfCorrection* gradient);

}  // namespace leonav
