#include "core/earth/rotation.h"
#include "core/base/angle.h"

#include <Eigen/LU>
#include <cmath>

#include "support/catch.h"

using namespace leonav;
using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

namespace {

// exp([v x]) by its defining series.
Matrix3d matrix_exponential(const Vector3d& v) {
  Matrix3d sum = Matrix3d::Identity(), term = Matrix3d::Identity();
  for (int n = 1; n < 60; ++n) {
    term = (term * skew(v) / n).eval();
    sum += term;
  }
  return sum;
}
}  // namespace

TEST_CASE("skew is the cross product", "[earth]") {
  const Vector3d a(1, -2, 3), b(0.3, 5, -7);
  CHECK((skew(a) * b - a.cross(b)).norm() < 1e-15);
}

TEST_CASE("Rotation vectors agree with the matrix exponential and come back", "[earth]") {
  const Vector3d axis = Vector3d(0.48, -0.6, 0.64);
  for (const double angle :
       {0.0, 1e-300, 1e-12, 1e-8, 9.9e-5, 1.01e-4, 1e-3, 1.0, 3.0, kPi - 1e-9, kPi}) {
    const Vector3d v = angle * axis;
    const Quaterniond q = quaternion_from_rotation_vector(v);
    CHECK(std::abs(q.norm() - 1.0) < 1e-15);
    CHECK((q.toRotationMatrix() - matrix_exponential(v)).norm() < 2e-14);
    CHECK((rotation_vector_from_quaternion(q) - v).norm() <= 1e-15 * angle + 1e-300);
    // The other sign of the quaternion is the same rotation.
    const Quaterniond minus(-q.w(), -q.x(), -q.y(), -q.z());
    if (angle < 3.1) CHECK((rotation_vector_from_quaternion(minus) - v).norm() <= 1e-15 * angle);
  }
  // Beyond half a turn the short way round comes back.
  const Vector3d back =
      rotation_vector_from_quaternion(quaternion_from_rotation_vector(4.0 * axis));
  CHECK((back - (4.0 - 2.0 * kPi) * axis).norm() < 1e-14);
}

TEST_CASE("Euler angles turn about down, then right, then forward", "[earth]") {
  const double roll = 0.3, pitch = -0.7, yaw = 2.5;
  const Matrix3d expected = matrix_exponential({0, 0, yaw}) * matrix_exponential({0, pitch, 0}) *
                            matrix_exponential({roll, 0, 0});
  const Matrix3d C_nb = rotation_from_euler({roll, pitch, yaw});
  CHECK((C_nb - expected).norm() < 1e-14);
  CHECK(C_nb.determinant() == Approx(1.0));
  // Nose up: the forward axis points up, which is minus down.
  CHECK(rotation_from_euler({0.0, 0.1, 0.0})(2, 0) < 0.0);
}

TEST_CASE("Euler angles come back, also near and at the vertical", "[earth]") {
  for (double roll = -3.1; roll <= 3.1; roll += 0.62) {
    for (double pitch = -1.57; pitch <= 1.571; pitch += 0.157) {
      for (double yaw = -3.1; yaw <= 3.1; yaw += 0.62) {
        const EulerAngles back = euler_from_rotation(rotation_from_euler({roll, pitch, yaw}));
        REQUIRE(std::abs(back.roll - roll) < 1e-11);
        REQUIRE(std::abs(back.pitch - pitch) < 1e-11);
        REQUIRE(std::abs(back.yaw - yaw) < 1e-11);
      }
    }
  }
  for (const double pitch : {-kPi / 2, kPi / 2}) {
    const Matrix3d C_nb = rotation_from_euler({0.4, pitch, 1.0});
    const Matrix3d again = rotation_from_euler(euler_from_rotation(C_nb));
    CHECK((again - C_nb).norm() < 1e-9);
  }
}

TEST_CASE("wrap_to_pi", "[earth]") {
  CHECK(wrap_to_pi(kPi) == kPi);
  CHECK(wrap_to_pi(-kPi) == kPi);
  CHECK(wrap_to_pi(3 * kPi + 0.1) == Approx(-kPi + 0.1));
  CHECK(wrap_to_pi(-0.25) == -0.25);
  CHECK(wrap_to_pi(200 * kPi + 1.0) == Approx(1.0));
}
