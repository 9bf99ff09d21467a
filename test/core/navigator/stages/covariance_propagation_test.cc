#include "core/navigator/stages/internal/covariance_propagation.h"

#include "core/earth/gravity.h"
#include "core/earth/rotation.h"
#include "core/inertial/strapdown/mechanization.h"
#include "support/catch.h"
#include "support/drive/synthetic_drive.h"

namespace leonav::test {
namespace {

// The transition by numerical differentiation: mechanize the same samples from disturbed anchors.
Eigen::Matrix<double, 9, 15> numerical_transition(const std::vector<ImuSample>& samples,
                                                  const NavState& anchor) {
  const auto run = [&](const Eigen::Matrix<double, 15, 1>& error) {
    NavState state = anchor;
    state.p_e += error.segment<3>(0);
    state.v_e += error.segment<3>(3);
    state.q_eb = quaternion_from_rotation_vector(error.segment<3>(6)) * state.q_eb;
    state.errors.gyro_bias_b += error.segment<3>(9);
    state.errors.accel_bias_b += error.segment<3>(12);
    Mechanization mechanization;
    mechanization.reset(state);
    for (const ImuSample& sample : samples) mechanization.advance(sample);
    return mechanization.state();
  };
  Eigen::Matrix<double, 9, 15> transition;
  for (int i = 0; i < 15; ++i) {
    const double h = i < 3 ? 1.0 : i < 6 ? 0.1 : 1e-4;
    Eigen::Matrix<double, 15, 1> error = Eigen::Matrix<double, 15, 1>::Zero();
    error(i) = h;
    const NavState plus = run(error), minus = run(-error);
    transition.block<3, 1>(0, i) = (plus.p_e - minus.p_e) / (2.0 * h);
    transition.block<3, 1>(3, i) = (plus.v_e - minus.v_e) / (2.0 * h);
    transition.block<3, 1>(6, i) =
        rotation_vector_from_quaternion(plus.q_eb * minus.q_eb.conjugate()) / (2.0 * h);
  }
  return transition;
}

TEST_CASE("growth over a second agrees with numerical differentiation of the mechanization") {
  SyntheticDriveOptions options;
  options.duration_s = 31.0;
  options.standstill_s = 0.0;
  std::vector<ImuSample> samples = synthetic_imu(options);
  samples.erase(samples.begin(), samples.begin() + 6000);
  Anchor anchor;
  anchor.state = SyntheticPath(options).state(30.0);
  anchor.covariance.diagonal().head<15>() << 1, 1, 1, 1e-2, 1e-2, 1e-2, 1e-4, 1e-4, 1e-3, 1e-6,
      1e-6, 1e-6, 1e-2, 1e-2, 1e-2;
  Mechanization mechanization;
  mechanization.reset(anchor.state);
  for (const ImuSample& sample : samples) mechanization.advance(sample);
  const NavState& end = mechanization.state();
  const Eigen::Vector3d f_e = (end.v_e - anchor.state.v_e) - gravity_e(end.p_e);
  const PvaCovariance closed =
      inertial_covariance(anchor, ImuErrorModel(), f_e, end.q_eb.toRotationMatrix(), 1.0);
  const auto transition = numerical_transition(samples, anchor.state);
  const PvaCovariance numerical =
      transition * anchor.covariance.topLeftCorner<15, 15>() * transition.transpose();
  for (int i = 0; i < 9; ++i) CHECK(closed(i, i) == Approx(numerical(i, i)).epsilon(0.02));
  const Eigen::Matrix<double, 9, 1> scale = numerical.diagonal().cwiseSqrt();
  const PvaCovariance difference =
      scale.cwiseInverse().asDiagonal() * (closed - numerical) * scale.cwiseInverse().asDiagonal();
  CHECK(difference.cwiseAbs().maxCoeff() < 0.02);
}

TEST_CASE("noise grows as the integrals of white noise do, in one step or in many") {
  PvaCovariance once = PvaCovariance::Zero(), twice = PvaCovariance::Zero();
  add_acceleration_noise(0.3, 2.0, &once);
  add_acceleration_noise(0.3, 1.0, &twice);
  PvaCovariance step = PvaCovariance::Identity();
  step.block<3, 3>(0, 3).setIdentity();
  twice = step * twice * step.transpose();
  add_acceleration_noise(0.3, 1.0, &twice);
  CHECK((once - twice).norm() < 1e-12);
  CHECK(once(0, 0) == Approx(0.09 * 8.0 / 3.0));
}

TEST_CASE("an attitude's wander grows into velocity and position as many small steps have it") {
  const Eigen::Vector3d f_e(3.0, -8.0, 5.0);
  const auto grown = [&](double noise, double wanders_s, double elapsed_s) {
    Anchor anchor;
    anchor.state.time = GpsTime::from_week_and_tow(2000, 100.0);
    anchor.random_walk = {noise, anchor.state.time.plus_seconds(wanders_s)};
    return inertial_covariance(anchor, ImuErrorModel(), f_e, Eigen::Matrix3d::Identity(),
                               elapsed_s);
  };
  constexpr double kNoise = 0.01, kSeconds = 4.0;
  constexpr int kSteps = 4000;
  Eigen::Matrix<double, 9, 9> step = Eigen::Matrix<double, 9, 9>::Identity();
  const double dt = kSeconds / kSteps;
  step.block<3, 3>(0, 3) = dt * Eigen::Matrix3d::Identity();
  for (int axis = 0; axis < 3; ++axis)  // velocity' = attitude x f
    step.block<3, 1>(3, 6 + axis) = dt * Eigen::Vector3d::Unit(axis).cross(f_e);
  const PvaCovariance none = grown(0.0, 10.0, kSeconds);
  for (const double wanders_s : {10.0, 4.0, 1.0}) {  // an end on the way is an end at its time
    CAPTURE(wanders_s);
    PvaCovariance P = PvaCovariance::Zero();
    for (int i = 0; i < kSteps; ++i) {
      P = step * P * step.transpose();
      if ((i + 0.5) * dt < wanders_s)
        P.block<3, 3>(6, 6) += kNoise * kNoise * dt * Eigen::Matrix3d::Identity();
    }
    const PvaCovariance off = grown(kNoise, wanders_s, kSeconds) - none - P;
    for (int row = 0; row < 9; row += 3)
      for (int column = 0; column < 9; column += 3)
        CHECK(off.block<3, 3>(row, column).norm() < 3e-3 * P.block<3, 3>(row, column).norm());
  }
  CHECK((grown(kNoise, 0.0, kSeconds) - none).norm() == 0.0);
}

TEST_CASE("constant velocity: position takes the velocity's uncertainty") {
  Anchor anchor;
  anchor.covariance(0, 0) = 4.0;
  anchor.covariance(3, 3) = 0.25;
  const PvaCovariance covariance = constant_velocity_covariance(anchor, 0.0, 4.0);
  CHECK(covariance(0, 0) == Approx(4.0 + 0.25 * 16.0));
  CHECK(covariance(3, 3) == Approx(0.25));
}

TEST_CASE("sigmas of roll, pitch, yaw: level they are the rotation's, tilted they are its share") {
  Eigen::Matrix3d covariance = Eigen::Vector3d(1e-4, 4e-4, 9e-4).asDiagonal();
  const Eigen::Vector3d level = sigma_of_euler(covariance, 0.0, 0.0);
  CHECK((level - Eigen::Vector3d(0.01, 0.02, 0.03)).norm() < 1e-12);
  const Eigen::Vector3d east = sigma_of_euler(covariance, 0.0, 1.5707963267948966);
  CHECK((east - Eigen::Vector3d(0.02, 0.01, 0.03)).norm() < 1e-12);
  CHECK(sigma_of_euler(covariance, 1.5707963267948966, 0.0).minCoeff() > 3.0);

  // By differentiation: a small rotation in n against the angles it changes.
  const EulerAngles angles{0.3, -0.7, 2.1};
  const Eigen::Matrix3d C = rotation_from_euler(angles);
  Eigen::Matrix3d jacobian;
  for (int i = 0; i < 3; ++i) {
    const double h = 1e-6;
    const Eigen::Vector3d axis = h * Eigen::Vector3d::Unit(i);
    const EulerAngles plus = euler_from_rotation(quaternion_from_rotation_vector(axis) * C);
    const EulerAngles minus = euler_from_rotation(quaternion_from_rotation_vector(-axis) * C);
    jacobian.col(i) << (plus.roll - minus.roll), (plus.pitch - minus.pitch), plus.yaw - minus.yaw;
    jacobian.col(i) /= 2.0 * h;
  }
  const Eigen::Matrix3d expected = jacobian * covariance * jacobian.transpose();
  const Eigen::Vector3d sigma = sigma_of_euler(covariance, angles.pitch, angles.yaw);
  CHECK((sigma - expected.diagonal().cwiseSqrt()).norm() < 1e-7);
}

}  // namespace
}  // namespace leonav::test
