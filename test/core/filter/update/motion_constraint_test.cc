// Constraints on the motion: their Jacobians and the recorded process that has met them, against
// numerical differences and a batch solution.
#include "core/filter/update/motion_constraint.h"

#include <cmath>
#include <functional>

#include "core/earth/rotation.h"
#include "core/filter/state/filter_process.h"
#include "support/catch.h"
#include "support/dense/dense_algebra.h"
#include "synthetic.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;

NavState turning_state() {
  NavState state;
  state.p_e = synthetic::start_position();
  const Eigen::Matrix3d C_en = synthetic::C_en_at(state.p_e);
  state.q_eb = Eigen::Quaterniond(C_en * rotation_from_euler({0.1, -0.2, 2.1}));
  state.v_e = C_en * Vector3d{9.0, -14.0, 0.5};
  state.errors.gyro_bias_b << 0.01, -0.02, 0.03;
  state.errors.gyro_scale << 0.02, 0.01, -0.03;
  return state;
}

const Vector3d kRate_b{0.3, -0.2, 0.8};
const Vector3d kPoint_b{-1.4, 0.2, 0.6};

NavState moved(const NavState& state, int index, double step) {
  FilterState whole;
  whole.nav = state;
  EkfCorrection error = EkfCorrection::Zero(kSize);
  error(index) = step;
  add(error, true, &whole);
  return whole.nav;
}

// The largest difference between `columns` and the fourth-order numerical derivative of `value`.
template <typename Columns>
double worst(const NavState& state, const Columns& columns,
             const std::function<Vector3d(const NavState&)>& value) {
  constexpr double kStep = 1e-3;
  double most = 0.0;
  for (int i = 0; i < kInsSize; ++i) {
    const auto at = [&](double steps) { return value(moved(state, i, steps * kStep)); };
    const Vector3d slope = (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * kStep);
    most = std::max(most, (slope - columns.row(i).transpose()).cwiseAbs().maxCoeff());
  }
  return most;
}

}  // namespace

TEST_CASE("the Jacobians of constraints on the motion are the numerical derivatives") {
  const NavState state = turning_state();
  const BodyVelocity velocity = body_velocity(state, kRate_b, kPoint_b);
  CHECK(worst(state, velocity.columns,
              [](const NavState& s) { return body_velocity(s, kRate_b, kPoint_b).v_b; }) < 1e-7);
  const StationaryGyroResidual rate = stationary_gyro_residual(state, kRate_b);
  CHECK(worst(state, rate.columns, [](const NavState& s) {
          return Vector3d(-stationary_gyro_residual(s, kRate_b).residual_b);
        }) < 1e-9);
}

TEST_CASE("the axes of travel are orthonormal, and their slopes the numerical derivatives") {
  constexpr double kYaw = 0.3, kPitch = -0.2, kStep = 1e-6;
  const TravelAxes axes = travel_axes(kYaw, kPitch);
  CHECK((axes.C_bv.transpose() * axes.C_bv).isIdentity(1e-14));
  CHECK(axes.C_bv.determinant() > 0.0);
  CHECK(axes.C_bv.col(0).y() > 0.0);  // yaw to the right
  CHECK(axes.C_bv.col(0).z() > 0.0);  // pitch below the horizon
  const Eigen::Matrix3d by_yaw =
      (travel_axes(kYaw + kStep, kPitch).C_bv - travel_axes(kYaw - kStep, kPitch).C_bv) /
      (2.0 * kStep);
  const Eigen::Matrix3d by_pitch =
      (travel_axes(kYaw, kPitch + kStep).C_bv - travel_axes(kYaw, kPitch - kStep).C_bv) /
      (2.0 * kStep);
  CHECK((by_yaw - axes.d_yaw).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((by_pitch - axes.d_pitch).cwiseAbs().maxCoeff() < 1e-9);
}

TEST_CASE("the rows of wheels and of an odometer are the slopes of what they predict") {
  FilterState state;
  state.nav = turning_state();
  state.vehicle = {0.05, -0.03, 0.02};
  MotionConstraintConfig config;
  config.non_holonomic = true;
  config.point_b = kPoint_b;
  config.odometer_point_b = {0.4, -0.7, 0.3};
  ConstraintInstant instant;
  instant.odometer = {true, 12.0, 0.3, 1e-3};
  const auto measure = [&](const FilterState& at) {
    MotionMeasurements measurements;
    motion_measurements(config, instant, at, kRate_b, &measurements);
    return measurements;
  };
  const MotionMeasurements here = measure(state);
  REQUIRE(here.size() == 3);
  CHECK(here[0].component == static_cast<int>(MotionComponent::kOdometer));
  constexpr double kStep = 1e-4;
  for (int i = 0; i < state.first_ambiguity(); ++i) {
    EkfCorrection error = EkfCorrection::Zero(state.first_ambiguity());
    error(i) = kStep;
    FilterState after = state, before = state;
    add(error, true, &after);
    add(-error, true, &before);
    for (std::size_t m = 0; m < here.size(); ++m) {
      const double slope =
          (measure(before)[m].residual - measure(after)[m].residual) / (2.0 * kStep);
      CHECK(std::abs(slope - here[m].row(i)) < 1e-6);
    }
  }
}

TEST_CASE("an odometer's residual is nothing where it shows the scaled mean before the change") {
  FilterState state;
  state.nav = turning_state();
  state.vehicle = {0.05, -0.03, 0.02};
  MotionConstraintConfig config;
  config.odometer_point_b = kPoint_b;
  config.odometer_sigma = 0.1;
  const double speed = forward_speed(state, kRate_b, kPoint_b);
  ConstraintInstant instant;
  instant.odometer = {true, 1.02 * (speed - 0.3), 0.3, 0.03};
  MotionMeasurements measurements;
  motion_measurements(config, instant, state, kRate_b, &measurements);
  REQUIRE(measurements.size() == 1);
  CHECK(std::abs(measurements[0].residual) < 1e-12);
  CHECK(measurements[0].variance == Approx(0.04));
}

TEST_CASE("a body's point moves as the body turns about it") {
  NavState state = turning_state();
  state.errors = ImuErrors();
  const Eigen::Matrix3d C_be = state.q_eb.toRotationMatrix().transpose();
  const Vector3d earth_b = C_be * Vector3d{0.0, 0.0, kEarthRotationRate};
  const Vector3d expected = C_be * state.v_e + (kRate_b - earth_b).cross(kPoint_b);
  CHECK((body_velocity(state, kRate_b, kPoint_b).v_b - expected).norm() < 1e-12);
}

// x_then with covariance P, x_now = F x_then + w, a measurement of x_now: by the conditioned
// process as by all equations at once.
TEST_CASE("a conditioned process tells what the measurement has told") {
  constexpr int n = 5;
  synthetic::Generator noise(7);
  const auto random = [&](int rows, int columns) {
    Eigen::MatrixXd m(rows, columns);
    for (double& x : m.reshaped()) x = noise.normal();
    return m;
  };
  const Eigen::MatrixXd F = random(n, n), A = random(n, n), B = random(n, n);
  const Eigen::MatrixXd N = A * A.transpose(), P = B * B.transpose();
  FilterProcess process;
  process.begin(n);
  process.transition.leftCols(n) = F;
  process.noise = N;
  const Eigen::VectorXd filter_moved = random(n, 1);  // what updates have made of the state
  process.transition.col(n) = -filter_moved;

  // All of [x_then, x_now], x_now about the process alone.
  Eigen::MatrixXd joint(2 * n, 2 * n);
  joint << P, P * F.transpose(), F * P, F * P * F.transpose() + N;
  Eigen::MatrixXd information = dense::inverse(joint);
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(2 * n);
  for (int i = 0; i < 3; ++i) {
    const EkfCorrection h = random(n, 1);
    const double innovation = noise.normal(), variance = 0.1 + i;
    process.condition(h, innovation, variance);
    information.bottomRightCorner(n, n) += h * h.transpose() / variance;
    gradient.tail(n) += h * (innovation + h.dot(filter_moved)) / variance;
  }
  const Eigen::VectorXd expected = dense::solve_symmetric(information, gradient);

  // x_then by the prior and what the process tells of it; x_now by the process.
  const Eigen::MatrixXd then = dense::inverse(P) + process.information;
  const Eigen::VectorXd x_then = dense::solve_symmetric(then, process.gradient);
  const Eigen::VectorXd x_now =
      process.transition.leftCols(n) * x_then + process.transition.col(n) + filter_moved;
  const Eigen::MatrixXd F_new = process.transition.leftCols(n);
  const Eigen::MatrixXd P_now = F_new * dense::inverse(then) * F_new.transpose() + process.noise;
  CHECK((x_then - expected.head(n)).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((x_now - expected.tail(n)).cwiseAbs().maxCoeff() < 1e-9);
  const Eigen::MatrixXd P_expected = dense::inverse(information).bottomRightCorner(n, n);
  CHECK((P_now - P_expected).cwiseAbs().maxCoeff() < 1e-9 * P_expected.cwiseAbs().maxCoeff());
}

TEST_CASE("what a conditioned process tells is nothing of ambiguities") {
  constexpr int kAmbiguities = 4, n = kMaxCore + kAmbiguities;
  synthetic::Generator noise(8);
  FilterProcess process;
  process.begin(n);
  for (int i = 0; i < kMaxCore; ++i)
    for (int j = 0; j < kMaxCore; ++j) process.transition(i, j) += 0.1 * noise.normal();
  Eigen::MatrixXd A(kMaxCore, kMaxCore);
  for (double& x : A.reshaped()) x = noise.normal();
  process.noise.topLeftCorner(kMaxCore, kMaxCore) = A * A.transpose();
  process.noise.diagonal().tail(kAmbiguities).setConstant(1e-4);  // they walk
  for (int i = 0; i < 3; ++i) {
    EkfCorrection h = EkfCorrection::Zero(n);
    for (int j = 0; j < kMaxCore; ++j) h(j) = noise.normal();
    process.condition(h, noise.normal(), 0.1 + i);
  }
  REQUIRE(process.gradient.size() == n);
  CHECK(process.information.rows() == kMaxCore);
  CHECK_FALSE(process.gradient.head(kMaxCore).isZero());
  CHECK(process.gradient.tail(kAmbiguities).isZero(0.0));
  CHECK(process.transition.topRows(kMaxCore).middleCols(kMaxCore, kAmbiguities).isZero(0.0));
}

}  // namespace leonav
