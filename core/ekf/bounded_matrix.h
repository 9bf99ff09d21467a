// Matrices and vectors whose size varies while their storage, inside the object, does not.
#pragma once
#include <Eigen/Core>

namespace leonav {

template <int kMaxRows, int kMaxColumns>
using BoundedMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxRows, kMaxColumns>;
template <int kMaxRows>
using BoundedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRows, 1>;

}  // namespace leonav
