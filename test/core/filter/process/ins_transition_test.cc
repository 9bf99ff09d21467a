#include "core/filter/process/ins_transition.h"

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <vector>

#include "core/inertial/strapdown/mechanization.h"
#include "support/catch.h"
#include "support/dense/dense_algebra.h"
#include "synthetic.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;

constexpr double kInterval_s = 0.005;

NavState start_state() {
  NavState state;
  state.time = synthetic::kStart;
  state.p_e = synthetic::start_position();
  const Eigen::Matrix3d C_en = synthetic::C_en_at(state.p_e);
  state.q_eb = Eigen::Quaterniond(C_en * rotation_from_euler({0.1, -0.2, 0.7}));
  state.v_e = C_en * Vector3d{12.0, 10.0, -1.0};
  state.errors.gyro_bias_b << 0.002, -0.003, 0.001;
  state.errors.accel_bias_b << 0.05, -0.03, 0.02;
  state.errors.gyro_scale << 0.01, -0.02, 0.015;
  state.errors.accel_scale << -0.01, 0.02, 0.01;
  return state;
}

// Measured increments of a lively second: turning at up to 1 rad/s about every axis.
std::vector<ImuSample> lively_samples(int count) {
  std::vector<ImuSample> samples;
  for (int k = 0; k < count; ++k) {
    const double t = (k + 0.5) * kInterval_s;
    ImuSample sample;
    sample.interval_ns = std::llround(kInterval_s * 1e9);
    sample.time = synthetic::kStart.plus_nanoseconds((k + 1) * sample.interval_ns);
    sample.delta_theta_b =
        kInterval_s * Vector3d{0.5 * std::sin(3 * t), 0.3 * std::cos(2 * t), 1.0 * std::sin(t + 1)};
    sample.delta_velocity_b =
        kInterval_s * Vector3d{2.0 * std::sin(t), 3.0 * std::cos(3 * t), -9.8 + std::sin(5 * t)};
    samples.push_back(sample);
  }
  return samples;
}

// The model's biases decay, the mechanization's do not: very long correlation times here.
ImuErrorModel slow_model() {
  ImuErrorModel model = synthetic::mems();
  for (GaussMarkov* process :
       {&model.gyro_bias, &model.accel_bias, &model.gyro_scale, &model.accel_scale})
    process->correlation_time_s = 1e12;
  return model;
}

NavState perturbed(const NavState& state, int index, double step) {
  NavState other = state;
  const int axis = index % 3;
  switch (index - axis) {
    case kPosition:
      other.p_e(axis) += step;
      break;
    case kVelocity:
      other.v_e(axis) += step;
      break;
    case kAttitude:
      other.q_eb = quaternion_from_rotation_vector(step * Vector3d::Unit(axis)) * state.q_eb;
      break;
    case kGyroBias:
      other.errors.gyro_bias_b(axis) += step;
      break;
    case kAccelBias:
      other.errors.accel_bias_b(axis) += step;
      break;
    case kGyroScale:
      other.errors.gyro_scale(axis) += step;
      break;
    default:
      other.errors.accel_scale(axis) += step;
  }
  return other;
}

Eigen::Matrix<double, 9, 1> difference(const NavState& a, const NavState& b) {
  Eigen::Matrix<double, 9, 1> d;
  d << a.p_e - b.p_e, a.v_e - b.v_e, rotation_vector_from_quaternion(a.q_eb * b.q_eb.conjugate());
  return d;
}

NavState run(const NavState& start, const std::vector<ImuSample>& samples) {
  Mechanization mechanization;
  mechanization.reset(start);
  for (const ImuSample& sample : samples) mechanization.advance(sample);
  return mechanization.state();
}

void add_all(const NavState& start, const std::vector<ImuSample>& samples, std::size_t from,
             std::size_t to, Mechanization* mechanization, InsTransition* transition) {
  (void)start;
  for (std::size_t k = from; k < to; ++k) {
    const Eigen::Matrix3d before = mechanization->state().q_eb.toRotationMatrix();
    mechanization->advance(samples[k]);
    transition->add({.C_eb = 0.5 * (before + mechanization->state().q_eb.toRotationMatrix()),
                     .f_b = mechanization->specific_force_b(),
                     .omega_ib_b = mechanization->omega_ib_b(),
                     .interval_s = samples[k].interval_s()});
  }
}

}  // namespace

TEST_CASE("the transition matrix is the derivative of the mechanization") {
  const NavState start = start_state();
  const auto samples = lively_samples(200);
  InsTransition transition;
  transition.begin(slow_model(), start.errors, gravity_gradient_e(start.p_e));
  Mechanization mechanization;
  mechanization.reset(start);
  add_all(start, samples, 0, samples.size(), &mechanization, &transition);
  const InsTransition::Matrix phi = transition.transition();

  constexpr std::array<double, 7> kSteps = {100.0, 1.0, 1e-4, 1e-4, 1e-2, 1e-4, 1e-4};
  double worst = 0.0;
  for (int column = 0; column < kInsSize; ++column) {
    const double step = kSteps[static_cast<std::size_t>(column / 3)];
    const Eigen::Matrix<double, 9, 1> numeric =
        difference(run(perturbed(start, column, step), samples),
                   run(perturbed(start, column, -step), samples)) /
        (2.0 * step);
    for (int block = 0; block < 3; ++block) {
      const Vector3d expected = numeric.segment<3>(3 * block);
      const Vector3d got = phi.col(column).segment<3>(3 * block);
      const double scale = std::max(expected.norm(), 1e-9);
      // Blocks that are nothing but a difference of tiny numbers (position on velocity through
      // the gradient of gravity, 3e-6) get the gradient's own 1 %.
      const double relative = (expected - got).norm() / scale;
      INFO("column " << column << " block " << block << " numeric " << expected.transpose()
                     << " analytic " << got.transpose());
      if (expected.norm() < 1e-8) {
        CHECK(got.norm() < 1e-7);
      } else {
        const bool by_gradient = column < 3 && block == 1;
        CHECK(relative < (by_gradient ? 0.02 : 2e-3));
        if (!by_gradient) worst = std::max(worst, relative);
      }
    }
  }
  WARN("worst relative difference over 1 s: " << worst);
}

TEST_CASE("accumulated sub-blocks move the covariance as sample by sample does") {
  const NavState start = start_state();
  const auto samples = lively_samples(200);
  const ImuErrorModel model = synthetic::mems();
  EkfCovariance initial = EkfCovariance::Zero(kSize, kSize);
  initial.diagonal().segment<3>(kPosition).setConstant(4.0);
  initial.diagonal().segment<3>(kVelocity).setConstant(0.01);
  initial.diagonal().segment<3>(kAttitude).setConstant(1e-4);
  initial.diagonal().segment<3>(kGyroBias).setConstant(1e-8);
  initial.diagonal().segment<3>(kAccelBias).setConstant(4e-4);
  initial.diagonal().segment<3>(kGyroScale).setConstant(1e-6);
  initial.diagonal().segment<3>(kAccelScale).setConstant(1e-6);
  initial.diagonal().tail<8>().setConstant(9.0);

  const auto propagate = [&](std::size_t per_block) {
    EkfCovariance P = initial;
    Mechanization mechanization;
    mechanization.reset(start);
    InsTransition transition;
    for (std::size_t k = 0; k < samples.size(); k += per_block) {
      transition.begin(model, start.errors, gravity_gradient_e(mechanization.state().p_e));
      add_all(start, samples, k, k + per_block, &mechanization, &transition);
      transition.propagate(&P);
    }
    return P;
  };
  const EkfCovariance single = propagate(1);
  for (const std::size_t per_block : {5U, 10U}) {
    const EkfCovariance blocks = propagate(per_block);
    double worst = 0.0;
    for (int i = 0; i < kSize; ++i)
      for (int j = 0; j < kSize; ++j)
        worst = std::max(
            worst, std::abs(blocks(i, j) - single(i, j)) / std::sqrt(single(i, i) * single(j, j)));
    WARN(per_block << " samples at once: worst relative difference " << worst);
    CHECK(worst < 1e-3);
  }
}

TEST_CASE("process noise alone is positive semidefinite and adds up over sub-blocks") {
  const NavState start = start_state();
  const auto samples = lively_samples(200);
  const ImuErrorModel model = synthetic::mems();
  const auto propagate = [&](std::size_t per_block) {
    EkfCovariance P = EkfCovariance::Zero(kSize, kSize);
    Mechanization mechanization;
    mechanization.reset(start);
    InsTransition transition;
    for (std::size_t k = 0; k < samples.size(); k += per_block) {
      transition.begin(model, start.errors, gravity_gradient_e(mechanization.state().p_e));
      add_all(start, samples, k, k + per_block, &mechanization, &transition);
      const InsTransition::Matrix Q = transition.noise();
      CHECK((Q - Q.transpose()).norm() == 0.0);
      const Eigen::VectorXd scale = Q.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::MatrixXd correlation = scale.asDiagonal() * Q * scale.asDiagonal();
      CHECK(dense::symmetric_parts(correlation).eigenvalues(0) > -1e-9);
      transition.propagate(&P);
    }
    return P;
  };
  const EkfCovariance single = propagate(1);
  const EkfCovariance blocks = propagate(5);
  for (int i = 0; i < kInsSize; ++i) {
    INFO("state " << i);
    CHECK(blocks(i, i) == Approx(single(i, i)).epsilon(1e-3));
  }
  // Attitude noise is the angle random walk over one second; the gyro scale's random_walk at 1
  // rad/s adds some 4 %.
  const double walk = model.angle_random_walk * model.angle_random_walk;
  CHECK(single(kAttitude, kAttitude) > walk);
  CHECK(single(kAttitude, kAttitude) < 1.05 * walk);
}

}  // namespace leonav
