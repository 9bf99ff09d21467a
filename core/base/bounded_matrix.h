// These types are matrices and vectors whose size varies at run time within a fixed capacity. Their
// storage lies inside the object, so that resizing up to the capacity never allocates.
#pragma once
#include <Eigen/Core>

namespace leonav {

template <int kMaxRows, int kMaxColumns>
using BoundedMatrix =
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxRows, kMaxColumns>;
template <int kMaxRows>
using BoundedVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxRows, 1>;

}  // namespace leonav
