// Jacobians of measurements and links against numerical differentiation.
#include "core/smoother/linearization.h"

#include <functional>
#include <memory>

#include "core/earth/rotation.h"
#include "core/smoother/linear_process_factor.h"
#include "drive_rig.h"
#include "support/catch.h"
#include "window_rig.h"

namespace leonav {
namespace {

using namespace synthetic;
using namespace ekf_index;
using Eigen::Index;

// Steps that suit the states' sizes and what a range is known to.
double step_of(Index i) {
  if (i < kVelocity) return 10.0;  // m
  if (i < kAttitude) return 1.0;
  if (i < kClock) return 1e-2;
  return 10.0;
}

FilterState moved(const Keyframe& keyframe, Index i, double by) {
  EkfCorrection error = EkfCorrection::Zero(kSize + keyframe.active.ambiguities);
  error(i) = by;
  FilterState state = keyframe.state;
  add(error, keyframe.has_attitude, &state);
  return state;
}

// Central differences of fourth order of f(state) over the active state `i`.
Eigen::VectorXd slope(const Keyframe& keyframe, Index i,
                      const std::function<Eigen::VectorXd(const FilterState&)>& f) {
  const double h = step_of(i);
  const auto at = [&](double steps) { return f(moved(keyframe, i, steps * h)); };
  return (8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))) / (12.0 * h);
}

Index whole_index(const ActiveStates& active, Index i) {
  if (i < active.core_size()) return active.core[static_cast<std::size_t>(i)];
  return kSize + i - active.core_size();
}

// Two keyframes whose estimates are far from where their process_factor was linearized.
std::unique_ptr<Window> window_of_two(bool inertial, Eigen::Vector3d* lever_b) {
  DriveOptions options;
  options.inertial = inertial;
  options.lever_b = {5.0, 3.0, -12.0};  // swings to be seen
  Drive drive(options);
  auto window = std::make_unique<Window>(3);
  for (int i = 0; i < 3; ++i) feed(drive.step(), drive.lever_b(), window.get());
  Generator noise(5);
  for (int k = 0; k < window->size(); ++k) {
    Keyframe& keyframe = window->at(k);
    EkfCorrection error(kSize + keyframe.active.ambiguities);
    for (double& value : error) value = 0.05 * noise.normal();
    error.segment<3>(kAttitude) = 0.5 * noise.normal3();
    add(error, keyframe.has_attitude, &keyframe.state);
  }
  *lever_b = drive.lever_b();
  return window;
}

}  // namespace

TEST_CASE("the rows of code, carrier and Doppler are the slopes of their residuals") {
  Eigen::Vector3d lever_b;
  const auto window = window_of_two(GENERATE(true, false), &lever_b);
  Keyframe& keyframe = window->newest();
  REQUIRE(keyframe.measurements.size() == 24);
  for (const KeyframeMeasurement& measurement : keyframe.measurements) {
    const LinearMeasurement linear =
        linearize(measurement, keyframe, antenna_of(keyframe, lever_b));
    const auto residual = [&](const FilterState& state) {
      auto there = std::make_unique<Keyframe>(keyframe);
      there->state = state;
      return Eigen::VectorXd::Constant(
          1, linearize(measurement, *there, antenna_of(*there, lever_b)).residual);
    };
    for (Index i = 0; i < keyframe.active.size(); ++i) {
      const Index state = whole_index(keyframe.active, i);
      double row = measurement.ambiguity == state - kSize ? 1.0 : 0.0;
      if (state < kSize) row = linear.row(state);
      CAPTURE(static_cast<int>(measurement.measurement.observable), state);
      CHECK(-slope(keyframe, state, residual)(0) ==
            Approx(row).epsilon(1e-6).margin(state < kAttitude ? 1e-8 : 2e-6));
    }
  }
}

TEST_CASE("the rows by lever arm and time offset are the slopes of residuals") {
  DriveOptions options;
  options.calibrating = true;
  options.lever_b = {5.0, 3.0, -12.0};
  Drive drive(options);
  Window window(3);
  for (int i = 0; i < 3; ++i) feed(drive.step(), drive.lever_b(), &window);
  Keyframe& keyframe = window.newest();
  keyframe.state.vehicle = {0.0, 0.0, 0.0, 0.3, -0.2, 0.4, 0.02};
  keyframe.acceleration_e = {1.0, -2.0, 0.5};
  CHECK(keyframe.active.core_size() >= kAntennaConstants);
  CHECK(keyframe.active.core.back() == kSize + kTimeOffset);
  for (const KeyframeMeasurement& measurement : keyframe.measurements) {
    const LinearMeasurement linear =
        linearize(measurement, keyframe, antenna_of(keyframe, drive.lever_b()));
    const auto residual = [&](std::size_t constant, double by) {
      auto there = std::make_unique<Keyframe>(keyframe);
      there->state.vehicle[constant] += by;
      return linearize(measurement, *there, antenna_of(*there, drive.lever_b())).residual;
    };
    for (std::size_t i = 0; i < keyframe.state.vehicle.size(); ++i) {
      const double step = i == kTimeOffset ? 0.01 : 1.0;
      const double slope = (residual(i, -step) - residual(i, step)) / (2.0 * step);
      CAPTURE(i, static_cast<int>(measurement.measurement.observable));
      CHECK(row_of(linear, kSize + static_cast<int>(i)) ==
            Approx(slope).epsilon(1e-5).margin(1e-5));
    }
  }
}

TEST_CASE("a process factor's Jacobians are its error's slopes, far from its linearization") {
  Eigen::Vector3d lever_b;
  const bool inertial = GENERATE(true, false);
  const auto window = window_of_two(inertial, &lever_b);
  Keyframe& before = window->at(1);
  Keyframe& keyframe = window->at(2);
  const auto process_factor = std::make_unique<LinearProcessFactor>();
  linearize_process_factor(before, keyframe, process_factor.get());
  // Its error is J^-1 (error - F error_before + offset) with the J of this keyframe.
  const Eigen::MatrixXd change =
      change_of_difference(keyframe.active, keyframe.state, keyframe.process_factor.to);
  CHECK(Eigen::MatrixXd(change).isIdentity(1e-3) == !inertial);
  CHECK((change * process_factor->offset - process_error(before, keyframe)).norm() < 1e-9);
  const Eigen::MatrixXd noise = change * process_factor->noise * change.transpose();
  CHECK(apart_in_correlations(noise + 1e-12 * Eigen::MatrixXd::Identity(noise.rows(), noise.rows()),
                              keyframe.process_factor.noise +
                                  1e-12 * Eigen::MatrixXd::Identity(noise.rows(), noise.rows())) <
        1e-9);
  for (Index i = 0; i < keyframe.active.size(); ++i) {
    const auto error = [&](const FilterState& state) {
      auto there = std::make_unique<Keyframe>(keyframe);
      there->state = state;
      return Eigen::VectorXd(process_error(before, *there));
    };
    CAPTURE(i);
    CHECK((slope(keyframe, whole_index(keyframe.active, i), error) - change.col(i)).norm() < 1e-7);
  }
  for (Index i = 0; i < before.active.size(); ++i) {
    const auto error = [&](const FilterState& state) {
      auto there = std::make_unique<Keyframe>(before);
      there->state = state;
      return Eigen::VectorXd(process_error(*there, keyframe));
    };
    CAPTURE(i);
    const Eigen::VectorXd column = -change * process_factor->F.col(i);
    CHECK((slope(before, whole_index(before.active, i), error) - column).norm() <
          1e-7 * (1.0 + column.norm()));
  }
}

TEST_CASE("the prior's gradient and curvature follow the estimate") {
  Eigen::Vector3d lever_b;
  const auto window = window_of_two(true, &lever_b);
  Keyframe& oldest = window->at(0);
  EkfCovariance information;
  EkfCorrection gradient;
  linearize_prior(*window, &information, &gradient);
  const WindowPrior& prior = window->prior();
  const auto cost = [&](const FilterState& state) {
    const EkfCorrection moved = active_part(oldest.active, difference(state, prior.at));
    return Eigen::VectorXd::Constant(
        1, 0.5 * moved.dot(prior.information * moved) - prior.gradient.dot(moved));
  };
  const EkfCorrection sigma = information.diagonal().cwiseSqrt().cwiseInverse();
  for (Index i = 0; i < oldest.active.size(); ++i) {
    const double numeric = slope(oldest, whole_index(oldest.active, i), cost)(0);
    CAPTURE(i);
    CHECK(-numeric * sigma(i) == Approx(gradient(i) * sigma(i)).epsilon(1e-5).margin(1e-2));
  }
}

TEST_CASE("both ways between an attitude's error and its difference undo each other") {
  const double angle = GENERATE(0.0, 1e-9, 1e-4, 0.0099, 0.0101, 0.3, 2.0, 3.0);
  FilterState estimate, linearized_at;
  estimate.nav.q_eb =
      quaternion_from_rotation_vector(angle * Eigen::Vector3d(2.0, -1.0, 2.0) / 3.0);
  ActiveStates active;
  for (int i = 0; i < kInsSize; ++i) active.core.push_back(i);
  const AttitudeJacobian change = attitude_jacobian(active, estimate, linearized_at);
  CHECK(change.index == kAttitude);
  CHECK((change.of_error * change.to_error - Eigen::Matrix3d::Identity()).norm() < 1e-11);
}

}  // namespace leonav
