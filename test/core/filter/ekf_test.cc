#include "core/filter/ekf.h"

#include <Eigen/Core>
#include <chrono>
#include <cmath>
#include <vector>

#include "core/filter/update/measurement_model.h"
#include "support/catch.h"
#include "support/dense/dense_algebra.h"
#include "support/drive/white_errors.h"
#include "synthetic.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;
using synthetic::Generator;

// Filter with an IMU beside its truth: 100 Hz, an epoch per second.
class Drive {
 public:
  Drive(const EkfConfig& config, const Vector3d& rpy_error, const Vector3d& sigma_rpy,
        std::uint64_t seed)
      : noise_(seed), config_(config), filter_(config, model_, lever_b_) {
    const Eigen::Matrix3d C_en = synthetic::C_en_at(synthetic::start_position());
    state_.time = synthetic::kStart;
    state_.p_e = synthetic::start_position();
    state_.v_e = C_en * Vector3d{10.0, 0.0, 0.0};
    state_.q_eb = Eigen::Quaterniond(C_en);
    errors_ = synthetic::draw_errors(model_, &noise_);
    truth_.clocks.offset_m.setConstant(1000.0);
    follow(Vector3d::Zero());
    filter_.initialize(state_.time, synthetic::point_near(truth_, 3.0, 0.2, &noise_));
    filter_.set_attitude(quaternion_from_rotation_vector(C_en * rpy_error) * state_.q_eb, sigma_rpy,
                         Vector3d::Zero(), synthetic::mems().gyro_bias.sigma);
  }

  // One second of IMU; `keep` false: the samples are lost.
  void predict(const synthetic::Maneuver& maneuver, bool keep = true) {
    constexpr double kStep = 0.01;
    std::vector<ImuSample> block;
    mechanization_.reset(state_);
    Vector3d rate_b;
    for (int k = 0; k < 100; ++k) {
      const ImuSample ideal = synthetic::ideal_sample(mechanization_.state(), maneuver, kStep);
      mechanization_.advance(ideal);
      synthetic::advance_errors(model_, kStep, &errors_, &noise_);
      block.push_back(synthetic::with_errors(ideal, model_, errors_, &noise_));
      rate_b = ideal.delta_theta_b / kStep;
    }
    state_ = mechanization_.state();
    synthetic::advance_clocks(config_.clock, 1.0, &truth_.clocks, &noise_);
    follow(rate_b);
    if (!keep) block.clear();
    filter_.predict(block, state_.time);
  }

  EkfUpdateResult update() { return filter_.update(measure()); }
  MeasurementEpoch measure() {
    return synthetic::measure(state_.time, synthetic::eight_satellites(), truth_, 3.0, 0.2,
                              &noise_);
  }

  Vector3d attitude_error() const {
    return rotation_vector_from_quaternion(state_.q_eb * filter_.state().q_eb.conjugate());
  }
  double yaw_error() const { return synthetic::C_en_at(state_.p_e).col(2).dot(attitude_error()); }
  double position_error() const { return (state_.p_e - filter_.state().p_e).norm(); }
  Ekf& filter() { return filter_; }
  const Vector3d& lever_b() const { return lever_b_; }
  const NavState& state() const { return state_; }
  const synthetic::Truth& truth() const { return truth_; }

 private:
  void follow(const Vector3d& rate_b) {
    const AntennaMotion antenna = antenna_motion(state_, rate_b, lever_b_, true);
    truth_.p_antenna_e = antenna.p_e;
    truth_.v_antenna_e = antenna.v_e;
  }

  Generator noise_;
  EkfConfig config_;
  ImuErrorModel model_ = synthetic::mems();
  Vector3d lever_b_{0.5, 0.3, -1.2};
  Ekf filter_;
  NavState state_;
  ImuErrors errors_;
  synthetic::Truth truth_;
  Mechanization mechanization_;
};

synthetic::Maneuver slalom(int second) {
  return {.yaw_rate = 0.3 * std::sin(0.4 * second), .acceleration = 1.5 * std::cos(0.5 * second)};
}

void drive_slalom(int seconds, Drive* drive) {
  for (int second = 0; second < seconds; ++second) {
    drive->predict(slalom(second));
    drive->update();
  }
}

}  // namespace

TEST_CASE("twenty degrees of heading error converge in turns, and not on the straight") {
  const Vector3d error{0.0, 0.0, 20.0 * M_PI / 180.0};
  const Vector3d sigma{0.02, 0.02, 0.35};
  Drive turning(white_error_config(), error, sigma, 1);
  Drive straight(white_error_config(), error, sigma, 1);
  CHECK(std::abs(turning.yaw_error()) == Approx(error.z()).epsilon(0.01));
  for (int second = 0; second < 60; ++second) {
    turning.predict(slalom(second));
    turning.update();
    straight.predict({});
    straight.update();
  }
  WARN("yaw error after 60 s: turning " << turning.yaw_error() * 180.0 / M_PI << " deg, straight "
                                        << straight.yaw_error() * 180.0 / M_PI << " deg");
  CHECK(std::abs(turning.yaw_error()) < 1.5 * M_PI / 180.0);
  CHECK(turning.position_error() < 6.0);
  const Vector3d down = synthetic::C_en_at(straight.state().p_e).col(2);
  const auto sigma_of = [&](Drive& drive) {
    const Eigen::Matrix3d P = drive.filter().covariance().block<3, 3>(kAttitude, kAttitude);
    return std::sqrt(down.dot(P * down));
  };
  CHECK(sigma_of(turning) < 0.02);
  CHECK(sigma_of(straight) > 3.0 * sigma_of(turning));  // and it knows
}

TEST_CASE("a start from few codes is as uncertain as so few residuals leave it") {
  // Two clocks beside the position. The variance of Student's t distribution with n degrees of
  // freedom is n / (n - 2).
  struct Start {
    int satellites;
    double factor;
  };
  const auto [satellites, factor] = GENERATE(Start{0, 1.0}, Start{6, 9.0}, Start{7, 9.0},
                                             Start{8, 3.0}, Start{9, 2.0}, Start{25, 20.0 / 18.0});
  CAPTURE(satellites);
  Drive drive(white_error_config(), Vector3d::Zero(), {0.02, 0.02, 0.1}, 2);
  Generator noise(3);
  PointSolution point = synthetic::point_near(drive.truth(), 2.0, 0.1, &noise);
  point.satellites = satellites;
  Ekf filter(white_error_config(), synthetic::mems(), {2.0, 1.0, -1.5});
  filter.initialize(synthetic::kStart, point);
  CHECK((filter.antenna_position_covariance_e() - factor * point.covariance_p_e).norm() < 1e-9);
  CHECK((filter.antenna_velocity_covariance_e() - point.covariance_v_e).norm() < 1e-12);
}

TEST_CASE("setting the attitude leaves the antenna where it was") {
  Drive drive(white_error_config(), Vector3d::Zero(), {0.02, 0.02, 0.1}, 2);
  Generator noise(3);
  Ekf filter(white_error_config(), synthetic::mems(), {2.0, 1.0, -1.5});
  filter.initialize(synthetic::kStart, synthetic::point_near(drive.truth(), 2.0, 0.1, &noise));
  const Vector3d p = filter.antenna_position_e();
  const Vector3d v = filter.antenna_velocity_e();
  const EkfCovariance before = filter.covariance();
  const Vector3d sigma_rpy{0.02, 0.03, 0.2};
  const Eigen::Matrix3d C_en = synthetic::C_en_at(p);
  const Eigen::Quaterniond q_eb(C_en * rotation_from_euler({0.1, 0.2, 1.0}));
  filter.set_attitude(q_eb, sigma_rpy, {0.01, 0.0, 0.0}, 1e-4);
  CHECK(filter.has_attitude());
  CHECK((filter.antenna_position_e() - p).norm() < 1e-8);
  CHECK((filter.antenna_velocity_e() - v).norm() < 1e-12);
  CHECK((p - filter.state().p_e).norm() == Approx(Vector3d(2.0, 1.0, -1.5).norm()));
  // The antenna's variance is what it was, seen through the new states: H P H^T.
  const AntennaMotion antenna =
      antenna_motion(filter.state(), Vector3d::Zero(), {2.0, 1.0, -1.5}, true);
  Eigen::Matrix<double, 3, kSize> H = Eigen::Matrix<double, 3, kSize>::Zero();
  H.block<3, 3>(0, kPosition).setIdentity();
  H.block<3, 3>(0, kAttitude) = antenna.d_p_d_attitude;
  const Eigen::Matrix3d through = H * filter.covariance() * H.transpose();
  CHECK((through - before.block<3, 3>(0, 0)).norm() < 1e-9);
  // Variances of roll, pitch, yaw by drawing: rotate, read the angles back.
  const double step = 1e-5;
  Eigen::Matrix3d J;  // d rotation in n / d angle, numerically
  for (int axis = 0; axis < 3; ++axis) {
    EulerAngles angles{0.1, 0.2, 1.0};
    (axis == 0 ? angles.roll : axis == 1 ? angles.pitch : angles.yaw) += step;
    const Eigen::Quaterniond moved(C_en * rotation_from_euler(angles));
    J.col(axis) = rotation_vector_from_quaternion(moved * q_eb.conjugate()) / step;
  }
  const Eigen::Matrix3d expected = J * sigma_rpy.cwiseAbs2().asDiagonal() * J.transpose();
  const Eigen::Matrix3d got = filter.covariance().block<3, 3>(kAttitude, kAttitude);
  CHECK((got - expected).norm() < 1e-4 * expected.norm());
}

TEST_CASE("started anew in a turn, the IMU's velocity is the antenna's less the arm's swing") {
  Drive drive(white_error_config(), Vector3d::Zero(), {0.02, 0.02, 0.1}, 6);
  for (int second = 0; second < 3; ++second) drive.predict({.yaw_rate = 1.0});
  Generator noise(7);
  const ImuErrors errors = drive.filter().state().errors;
  drive.filter().initialize(drive.state().time,
                            synthetic::point_near(drive.truth(), 1e-3, 1e-3, &noise));
  drive.filter().set_attitude(drive.state().q_eb, {0.02, 0.02, 0.1}, errors,
                              ImuErrorCovariance::Identity());
  CHECK((drive.filter().state().v_e - drive.state().v_e).norm() < 0.02);  // swing: 0.58 m/s
}

TEST_CASE("a heading from outside leaves the antenna and the IMU's errors as they are") {
  Drive drive(white_error_config(), Vector3d::Zero(), {0.02, 0.02, 0.1}, 8);
  drive_slalom(60, &drive);
  Ekf& filter = drive.filter();
  const NavState before = filter.state();
  const EkfCovariance P = filter.covariance();
  const Vector3d p_antenna = filter.antenna_position_e(), v_antenna = filter.antenna_velocity_e();
  const Eigen::Matrix3d C_en = synthetic::C_en_at(before.p_e);
  const Eigen::Quaterniond turned =
      quaternion_from_rotation_vector(C_en * Vector3d{0.0, 0.0, 0.3}) * before.q_eb;
  filter.replace_attitude(turned, {0.01, 0.01, 0.05});
  CHECK((filter.antenna_position_e() - p_antenna).norm() < 1e-8);
  CHECK((filter.antenna_velocity_e() - v_antenna).norm() < 1e-8);
  CHECK(filter.state().q_eb.angularDistance(turned) < 1e-12);
  CHECK(filter.state().errors.gyro_bias_b == before.errors.gyro_bias_b);
  CHECK(filter.state().errors.accel_bias_b == before.errors.accel_bias_b);
  const int errors = kInsSize - kGyroBias;
  const auto kept = [&](const EkfCovariance& M) {
    return M.block(kGyroBias, kGyroBias, errors, errors);
  };
  CHECK((kept(filter.covariance()) - kept(P)).norm() < 1e-12 * kept(P).norm());
  CHECK(filter.covariance().block<3, 3>(kAttitude, kAttitude).trace() ==
        Approx(2e-4 + 2.5e-3).epsilon(1e-3));
  CHECK(dense::symmetric_parts(filter.covariance()).eigenvalues(0) > -1e-9);
}

TEST_CASE("without its attitude the filter knows the antenna and the clocks as well as before") {
  Drive drive(white_error_config(), Vector3d::Zero(), {0.02, 0.02, 0.1}, 8);
  const bool constants = GENERATE(false, true);  // lever arm and time offset are estimated
  CAPTURE(constants);
  if (constants) drive.filter().estimate_constant(kTimeOffset);
  drive_slalom(60, &drive);
  Ekf& filter = drive.filter();
  const EkfCovariance P = filter.covariance();
  const Vector3d p_antenna = filter.antenna_position_e(), v_antenna = filter.antenna_velocity_e();
  const GpsTime time = filter.state().time;
  // By how much the antenna moves with each error state.
  const AntennaMotion antenna =
      antenna_motion(filter.state(), filter.body().measured_rate_b, drive.lever_b(), true,
                     filter.filter_state().vehicle, filter.body().acceleration_e);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(6, P.rows());
  H.block<6, 6>(0, kPosition).setIdentity();
  H.block<3, 3>(0, kAttitude) = antenna.d_p_d_attitude;
  H.block<3, 3>(3, kAttitude) = antenna.d_v_d_attitude;
  H.block<3, 3>(3, kGyroBias) = antenna.d_v_d_gyro_bias;
  H.block<3, 3>(3, kGyroScale) = antenna.d_v_d_gyro_scale;
  if (constants) {
    H.block<3, kAntennaConstants>(0, kSize + kLeverArm) = antenna.d_p_d_constants;
    H.block<3, kAntennaConstants>(3, kSize + kLeverArm) = antenna.d_v_d_constants;
  }
  const Eigen::MatrixXd expected = H * P * H.transpose();
  filter.forget_attitude();
  CHECK_FALSE(filter.has_attitude());
  CHECK(filter.state().time == time);
  CHECK(filter.state().errors.gyro_bias_b.isZero(0.0));
  CHECK((filter.antenna_position_e() - p_antenna).norm() < 1e-8);
  CHECK((filter.antenna_velocity_e() - v_antenna).norm() < 1e-8);
  const EkfCovariance after = filter.covariance();
  REQUIRE(after.rows() == P.rows());
  CHECK((after.block<6, 6>(0, 0) - expected).norm() < 1e-9 * expected.norm());
  CHECK(after.middleRows<kInsSize - kAttitude>(kAttitude).isZero(0.0));
  const auto rest = P.rows() - kInsSize;
  CHECK(after.bottomRightCorner(rest, rest) == P.bottomRightCorner(rest, rest));
  CHECK((after.block(0, kInsSize, 6, rest) - H * P.rightCols(rest)).norm() < 1e-9 * P.norm());
  drive.update();  // as a filter without attitude does
  CHECK((filter.antenna_position_e() - drive.truth().p_antenna_e).norm() < 3.0);
  filter.forget_attitude();  // again: nothing
  CHECK_FALSE(filter.has_attitude());
}

TEST_CASE("corrections between blocks do not interrupt coning and sculling") {
  // A sensor that shakes: in one block, and in blocks of two samples.
  const auto run = [](int per_block) {
    Ekf filter(white_error_config(), synthetic::mems(), Vector3d::Zero());
    Generator noise(9);
    synthetic::Truth truth;
    truth.p_antenna_e = synthetic::start_position();
    filter.initialize(synthetic::kStart, synthetic::point_near(truth, 1.0, 0.1, &noise));
    filter.set_attitude(Eigen::Quaterniond(synthetic::C_en_at(truth.p_antenna_e)),
                        {0.01, 0.01, 0.01}, Vector3d::Zero(), synthetic::mems().gyro_bias.sigma);
    std::vector<ImuSample> block;
    for (int k = 1; k <= 2000; ++k) {
      ImuSample sample;
      sample.interval_ns = 5'000'000;
      sample.time = synthetic::kStart.plus_nanoseconds(k * sample.interval_ns);
      const double a = 2.0 * M_PI * 0.11 * k;
      sample.delta_theta_b << 0.02 * std::sin(a), 0.02 * std::cos(a), 0.0;
      sample.delta_velocity_b << 0.0, 0.0, -9.8 * sample.interval_s();
      block.push_back(sample);
      if (k % per_block != 0) continue;
      filter.predict(block, sample.time);
      block.clear();
    }
    return filter.state().q_eb;
  };
  const double difference = run(2000).angularDistance(run(2));
  WARN("blocks of two samples instead of one of 2000: " << difference << " rad after 10 s");
  CHECK(difference < 1e-9);
}

TEST_CASE("an attitude that wanders is as much less certain, for as long as it was told to") {
  constexpr double kNoise = 0.01;  // rad/sqrt(s)
  EkfConfig config = white_error_config();
  config.keep_process = true;
  Drive drive(config, Vector3d::Zero(), {0.02, 0.02, 0.1}, 6);
  Drive plain(config, Vector3d::Zero(), {0.02, 0.02, 0.1}, 6);
  drive.filter().raise_attitude_noise(kNoise, 3.0);
  for (Drive* one : {&drive, &plain}) one->filter().begin_process();
  for (int second = 1; second <= 5; ++second) {
    for (Drive* one : {&drive, &plain}) one->predict(slalom(second));
    const auto more = [&](const auto& of) {
      const Eigen::Matrix3d apart = of(drive.filter()) - of(plain.filter());
      return Vector3d(apart.diagonal());
    };
    const Vector3d variance = more([](Ekf& filter) -> Eigen::Matrix3d {
      return filter.covariance().block<3, 3>(kAttitude, kAttitude);
    });
    // What the smoother is told of it.
    const Vector3d noise = more([](Ekf& filter) -> Eigen::Matrix3d {
      return filter.estimate().process().noise.block<3, 3>(kAttitude, kAttitude);
    });
    const double expected = kNoise * kNoise * std::min(second, 3);
    CHECK((variance - Vector3d::Constant(expected)).cwiseAbs().maxCoeff() < 0.01 * expected);
    CHECK((noise - Vector3d::Constant(expected)).cwiseAbs().maxCoeff() < 0.01 * expected);
  }
  CHECK(drive.filter().state().p_e == plain.filter().state().p_e);
  // It goes with the state for whoever integrates the same samples again, and ends with the filter.
  CHECK(drive.filter().filter_state().random_walk.noise == kNoise);
  drive.filter().initialize(drive.state().time, PointSolution());
  CHECK(drive.filter().filter_state().random_walk.noise == 0.0);
}

TEST_CASE("a hole in the IMU data widens the covariance and the filter comes back") {
  Drive drive(white_error_config(), Vector3d::Zero(), {0.02, 0.02, 0.1}, 4);
  drive_slalom(20, &drive);
  const EkfCovariance before = drive.filter().covariance();
  for (int second = 20; second < 23; ++second) drive.predict({}, false);
  const EkfCovariance& after = drive.filter().covariance();
  for (const int state : {kPosition, kVelocity, kAttitude})
    CHECK(after(state, state) > before(state, state));
  CHECK(drive.filter().state().time == drive.state().time);
  for (int second = 23; second < 50; ++second) {
    drive.update();
    drive.predict(slalom(second));
  }
  CHECK(drive.position_error() < 8.0);
  CHECK(drive.attitude_error().norm() < 0.06);
}

TEST_CASE("samples that overlap, repeat or lie beyond the epoch do no harm") {
  Drive drive(white_error_config(), Vector3d::Zero(), {0.02, 0.02, 0.1}, 5);
  Drive other(white_error_config(), Vector3d::Zero(), {0.02, 0.02, 0.1}, 5);
  const auto sample = [](int from_ms, int to_ms) {
    ImuSample s;
    s.interval_ns = (to_ms - from_ms) * 1'000'000LL;
    s.time = synthetic::kStart.plus_nanoseconds(to_ms * 1'000'000LL);
    s.delta_velocity_b << 0.0, 0.0, -9.8 * s.interval_s();
    return s;
  };
  const std::vector<ImuSample> clean = {sample(0, 10), sample(10, 20), sample(20, 30)};
  std::vector<ImuSample> dirty = {sample(0, 10), sample(0, 10), sample(5, 20), sample(20, 30),
                                  sample(30, 90)};
  ImuSample empty = sample(20, 30);
  empty.interval_ns = 0;
  dirty.insert(dirty.begin() + 3, empty);
  const GpsTime end = synthetic::kStart.plus_nanoseconds(30'000'000);
  drive.filter().predict(clean, end);
  other.filter().predict(dirty, end);
  CHECK(other.filter().state().time == end);
  CHECK((drive.filter().state().p_e - other.filter().state().p_e).norm() < 1e-6);
  CHECK((drive.filter().state().v_e - other.filter().state().v_e).norm() < 1e-6);
  other.filter().predict(clean, synthetic::kStart);  // the past: nothing
  CHECK(other.filter().state().time == end);
}

TEST_CASE("an hour of inertial filtering keeps the covariance positive") {
  Drive drive(white_error_config(), Vector3d::Zero(), {0.02, 0.02, 0.1}, 6);
  double smallest = 1.0;
  double worst = 0.0;
  for (int second = 0; second < 3600; ++second) {
    drive.predict(slalom(second));
    drive.update();
    const EkfCovariance& P = drive.filter().covariance();
    CHECK((P - P.transpose()).norm() == 0.0);
    if (second % 60 != 59) continue;
    // Of the correlation matrix, without the two bases that nothing has observed.
    std::vector<int> active;
    for (int i = 0; i < kSize; ++i)
      if (P(i, i) > 0.0) active.push_back(i);
    CHECK(active.size() == 25);
    Eigen::MatrixXd correlation(25, 25);
    for (int i = 0; i < 25; ++i)
      for (int j = 0; j < 25; ++j) {
        const int a = active[static_cast<std::size_t>(i)], b = active[static_cast<std::size_t>(j)];
        correlation(i, j) = P(a, b) / std::sqrt(P(a, a) * P(b, b));
      }
    smallest = std::min(smallest, dense::symmetric_parts(correlation).eigenvalues(0));
    worst = std::max(worst, drive.position_error());
  }
  WARN("smallest eigenvalue of the correlation matrix in 1 h: "
       << smallest << ", worst position error " << worst << " m");
  CHECK(smallest > 0.0);
  CHECK(worst < 8.0);
}

TEST_CASE("cost of prediction and update") {
  Drive drive(white_error_config(), Vector3d::Zero(), {0.02, 0.02, 0.1}, 7);
  const auto now = [] { return std::chrono::steady_clock::now(); };
  std::vector<ImuSample> block;
  Mechanization mechanization;
  mechanization.reset(drive.state());
  for (int k = 0; k < 1000; ++k) {
    block.push_back(synthetic::ideal_sample(mechanization.state(), slalom(k / 200), 0.005));
    mechanization.advance(block.back());
  }
  const auto start = now();
  drive.filter().predict(block, block.back().time);
  const double predict_us = std::chrono::duration<double, std::micro>(now() - start).count();
  // Thirty satellites: sixty measurements.
  std::vector<SatelliteInView> sky;
  for (int i = 0; i < 30; ++i)
    sky.push_back(synthetic::satellite_at(i % 2 == 0 ? System::kGps : System::kGalileo,
                                          static_cast<std::uint16_t>(i + 1), 0.21 * i,
                                          0.3 + 0.03 * i));
  Generator noise(8);
  synthetic::Truth truth = drive.truth();
  truth.p_antenna_e = drive.filter().antenna_position_e();
  truth.v_antenna_e = drive.filter().antenna_velocity_e();
  const MeasurementEpoch epoch =
      synthetic::measure(block.back().time, sky, truth, 3.0, 0.2, &noise);
  const auto middle = now();
  int used = 0;
  for (int i = 0; i < 20; ++i) used += drive.filter().update(epoch).used;
  const double update_us = std::chrono::duration<double, std::micro>(now() - middle).count() / 20;
  WARN("prediction " << predict_us / 1000.0 << " us per IMU sample, update with 60 measurements "
                     << update_us << " us");
  CHECK(used > 20 * 55);
}

}  // namespace leonav
