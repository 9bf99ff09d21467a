// Is the covariance true? Normalized estimation errors squared over 100 runs against the chi-square
// band (Bar-Shalom, Li, Kirubarajan 2001, 5.4.2).
#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "core/filter/ekf.h"
#include "core/filter/update/measurement_model.h"
#include "nees.h"
#include "support/catch.h"
#include "support/drive/white_errors.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;
using synthetic::Generator;

using synthetic::kLeastNees3;
using synthetic::kRuns;

double nees(const Vector3d& error, const EkfCovariance& P, int index) {
  return synthetic::nees(error, P.block<3, 3>(index, index));
}

// What IGG-III costs where nothing is wrong. With normal errors x of sigma 1 and factors w(x), an
// estimate from many measurements has the variance E[psi^2] / E[psi']^2 with psi = x w (Huber,
// Robust Statistics, 1981, 3.2), and claims 1 / E[w]: its NEES is too large by the ratio. E[psi']
// is E[x psi] for normal x. k0 = 1.5, k1 = 5: 0.953 claimed of the information and 0.878 had, ratio
// 1.085. A prior that is true takes its part of the estimate out of this: the ratio is a limit.
double robust_loss(const RobustConfig& robust) {
  double claimed = 0.0, square = 0.0, slope = 0.0;
  constexpr double kStep = 1e-3;
  for (double x = -8.0; x < 8.0; x += kStep) {
    const double p = std::exp(-0.5 * x * x) / std::sqrt(2.0 * M_PI) * kStep;
    const double w = igg3_factor(x, robust.k0, robust.k1);
    claimed += p * w;
    square += p * x * w * x * w;
    slope += p * x * x * w;
  }
  return square / (slope * slope) * claimed;
}

// The upper end of the band raised by what weights cost.
void check_band(const char* what, double sum, const RobustConfig& robust) {
  const double mean = sum / kRuns;
  const double upper = synthetic::kMostNees3 * (robust.enabled ? robust_loss(robust) : 1.0);
  WARN(what << (robust.enabled ? ", weighted" : "") << ": mean NEES " << mean
            << " (3 degrees, 95 % band " << kLeastNees3 << " to " << upper << ")");
  CHECK(mean > kLeastNees3);
  CHECK(mean < upper);
}

}  // namespace

TEST_CASE("constant-velocity filter: errors are as large as its covariance says") {
  EkfConfig config = white_error_config();
  config.robust.enabled = GENERATE(false, true);  // as shipped: true
  config.clock.inter_system_drift_noise = 0.01;
  const auto sky = synthetic::eight_satellites();
  const Eigen::Matrix3d C_en = synthetic::C_en_at(synthetic::start_position());
  double position = 0.0, velocity = 0.0, nis = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Generator noise(static_cast<std::uint64_t>(run) + 100);
    synthetic::Truth truth;
    truth.p_antenna_e = synthetic::start_position();
    truth.v_antenna_e = C_en * Vector3d{10.0, 5.0, 0.0};
    truth.clocks.offset_m.setConstant(5e4);
    truth.clocks.offset_m(1) += 30.0;
    truth.clocks.drift_m_s.setConstant(60.0);
    Ekf filter(config, ImuErrorModel{}, Vector3d::Zero());
    GpsTime time = synthetic::kStart;
    filter.initialize(time, synthetic::point_near(truth, 4.0, 0.3, &noise));
    for (int k = 0; k < 60; ++k) {
      constexpr double kDt = 1.0;
      synthetic::move_a_second(config, C_en, &truth, &noise);
      synthetic::advance_clocks(config.clock, kDt, &truth.clocks, &noise);
      time = time.plus_seconds(kDt);
      filter.predict({}, time);
      nis += filter.update(synthetic::measure(time, sky, truth, 3.0, 0.2, &noise)).nis;
    }
    position += nees(truth.p_antenna_e - filter.state().p_e, filter.covariance(), kPosition);
    velocity += nees(truth.v_antenna_e - filter.state().v_e, filter.covariance(), kVelocity);
  }
  check_band("constant velocity, position", position, config.robust);
  check_band("constant velocity, velocity", velocity, config.robust);
  // 100 runs of 60 epochs of 16 innovations: within three standard deviations.
  const double degrees = 16.0 * 60.0 * kRuns;
  WARN("innovations: " << nis / degrees << " per degree of freedom");
  if (!config.robust.enabled) CHECK(std::abs(nis - degrees) < 3.0 * std::sqrt(2.0 * degrees));
}

TEST_CASE("inertial filter: errors are as large as its covariance says, with carriers too") {
  EkfConfig config = white_error_config();
  config.use_carrier = GENERATE(false, true);
  config.robust.enabled = GENERATE(false, true);  // as shipped: true
  const ImuErrorModel model = synthetic::mems();
  const Vector3d lever_b{0.5, 0.3, -1.2};
  const auto sky = synthetic::eight_satellites();
  const Eigen::Matrix3d C_en = synthetic::C_en_at(synthetic::start_position());
  constexpr double kStep = 0.01;
  constexpr int kPerEpoch = 100, kEpochs = 30;
  const Vector3d sigma_rpy{0.02, 0.02, 0.08};

  // The truth is the same for all runs: a start, then turns left and right.
  std::vector<ImuSample> ideal;
  std::vector<NavState> states;
  NavState start;
  start.time = synthetic::kStart;
  start.p_e = synthetic::start_position();
  start.v_e = C_en * Vector3d{8.0, 0.0, 0.0};
  start.q_eb = Eigen::Quaterniond(C_en);
  Mechanization mechanization;
  mechanization.reset(start);
  for (int k = 0; k < kEpochs * kPerEpoch; ++k) {
    const double t = k * kStep;
    const synthetic::Maneuver maneuver{.yaw_rate = 0.4 * std::sin(0.5 * t),
                                       .acceleration = std::cos(0.7 * t)};
    ideal.push_back(synthetic::ideal_sample(mechanization.state(), maneuver, kStep));
    mechanization.advance(ideal.back());
    states.push_back(mechanization.state());
  }

  double position = 0.0, velocity = 0.0, attitude = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    Generator noise(static_cast<std::uint64_t>(run) + 5000);
    ImuErrors errors = synthetic::draw_errors(model, &noise);
    synthetic::Truth truth;
    truth.clocks.offset_m.setConstant(100.0);
    const auto antenna_of = [&](const NavState& state, const Vector3d& rate_b) {
      const AntennaMotion antenna = antenna_motion(state, rate_b, lever_b, true);
      truth.p_antenna_e = antenna.p_e;
      truth.v_antenna_e = antenna.v_e;
    };
    antenna_of(start, Vector3d::Zero());
    const Eigen::VectorXd ambiguities_m = Eigen::VectorXd::LinSpaced(8, -40.0, 60.0);

    Ekf filter(config, model, lever_b);
    filter.initialize(start.time, synthetic::point_near(truth, 3.0, 0.2, &noise));
    // Roll, pitch, yaw errors; the attitude is level and north, so axes of n and b agree.
    const Vector3d rotation = sigma_rpy.cwiseProduct(noise.normal3());
    filter.set_attitude(quaternion_from_rotation_vector(C_en * -rotation) * start.q_eb, sigma_rpy,
                        Vector3d::Zero(), synthetic::mems().gyro_bias.sigma);
    for (int epoch = 0; epoch < kEpochs; ++epoch) {
      std::vector<ImuSample> block;
      Vector3d rate_b = Vector3d::Zero();
      for (int k = 0; k < kPerEpoch; ++k) {
        const ImuSample& sample = ideal[static_cast<std::size_t>(epoch * kPerEpoch + k)];
        synthetic::advance_errors(model, kStep, &errors, &noise);
        block.push_back(synthetic::with_errors(sample, model, errors, &noise));
        rate_b = sample.delta_theta_b / kStep;
      }
      const NavState& true_state = states[static_cast<std::size_t>((epoch + 1) * kPerEpoch - 1)];
      synthetic::advance_clocks(config.clock, kPerEpoch * kStep, &truth.clocks, &noise);
      antenna_of(true_state, rate_b);
      filter.predict(block, true_state.time);
      MeasurementEpoch measured = synthetic::measure(true_state.time, sky, truth, 3.0, 0.2, &noise);
      if (config.use_carrier)
        synthetic::add_carriers(truth, ambiguities_m, 0.0, 0.005, epoch, &noise, &measured);
      filter.update(measured);
    }
    const NavState& last = states.back();
    position += nees(last.p_e - filter.state().p_e, filter.covariance(), kPosition);
    velocity += nees(last.v_e - filter.state().v_e, filter.covariance(), kVelocity);
    attitude += nees(rotation_vector_from_quaternion(last.q_eb * filter.state().q_eb.conjugate()),
                     filter.covariance(), kAttitude);
  }
  check_band(config.use_carrier ? "inertial with carriers, position" : "inertial, position",
             position, config.robust);
  check_band(config.use_carrier ? "inertial with carriers, velocity" : "inertial, velocity",
             velocity, config.robust);
  check_band(config.use_carrier ? "inertial with carriers, attitude" : "inertial, attitude",
             attitude, config.robust);
}

}  // namespace leonav
