// Lost IMU samples: one costs next to nothing, whichever it is.
#include <cmath>
#include <vector>

#include "core/filter/ekf.h"
#include "core/filter/update/measurement_model.h"
#include "support/catch.h"
#include "synthetic.h"

namespace leonav {
namespace {

using namespace ekf_index;
using Eigen::Vector3d;
using synthetic::Generator;

constexpr double kSample_s = 0.005;
constexpr int kPerSecond = 200;

ImuErrorModel tactical() {
  ImuErrorModel model;
  model.angle_random_walk = 0.07 / 60.0 * M_PI / 180.0;
  model.velocity_random_walk = 0.03 / 60.0;
  model.gyro_bias = {1.0 / 3600.0 * M_PI / 180.0, 3600.0};
  model.accel_bias = {5e-4, 3600.0};
  model.gyro_scale = {1e-4, 10'000.0};
  model.accel_scale = {1e-4, 10'000.0};
  return model;
}

struct TunnelOutcome {
  double error_m = 0.0, sigma_m = 0.0;
  double nees_position = 0.0;
  int lost = 0;
};

// Two minutes under open sky, then a tunnel of 60 s. Each sample begins with probability `loss` a
// hole of `burst` samples.
TunnelOutcome tunnel(double loss, int burst, std::uint64_t seed) {
  constexpr int kOpen = 120, kTunnel = 60;
  Generator noise(seed), losses(seed + 77);
  const EkfConfig config;
  const ImuErrorModel model = tactical();
  const Vector3d lever_b{0.5, 0.3, -1.2};
  const Eigen::Matrix3d C_en = synthetic::C_en_at(synthetic::start_position());
  NavState state;
  state.time = synthetic::kStart;
  state.p_e = synthetic::start_position();
  state.v_e = C_en * Vector3d{10.0, 0.0, 0.0};
  state.q_eb = Eigen::Quaterniond(C_en);
  ImuErrors errors = synthetic::draw_errors(model, &noise);
  synthetic::Truth truth;
  const auto follow = [&](const Vector3d& rate_b) {
    const AntennaMotion antenna = antenna_motion(state, rate_b, lever_b, true);
    truth.p_antenna_e = antenna.p_e;
    truth.v_antenna_e = antenna.v_e;
  };
  follow(Vector3d::Zero());
  Ekf filter(config, model, lever_b);
  filter.initialize(state.time, synthetic::point_near(truth, 3.0, 0.2, &noise));
  filter.set_attitude(state.q_eb, {0.005, 0.005, 0.02}, Vector3d::Zero(),
                      synthetic::mems().gyro_bias.sigma);
  Mechanization mechanization;
  mechanization.reset(state);
  TunnelOutcome outcome;
  int still_lost = 0;
  for (int second = 0; second < kOpen + kTunnel; ++second) {
    std::vector<ImuSample> block;
    Vector3d rate_b = Vector3d::Zero();
    for (int k = 0; k < kPerSecond; ++k) {
      const double t = second + k * kSample_s;
      const synthetic::Maneuver maneuver{.yaw_rate = 0.2 * std::sin(0.4 * t),
                                         .acceleration = 1.5 * std::cos(0.5 * t)};
      const ImuSample ideal = synthetic::ideal_sample(mechanization.state(), maneuver, kSample_s);
      mechanization.advance(ideal);
      synthetic::advance_errors(model, kSample_s, &errors, &noise);
      const ImuSample measured = synthetic::with_errors(ideal, model, errors, &noise);
      rate_b = ideal.delta_theta_b / kSample_s;
      if (losses.uniform() < loss) still_lost = burst;
      if (still_lost > 0) {
        --still_lost;
        ++outcome.lost;
      } else {
        block.push_back(measured);
      }
    }
    state = mechanization.state();
    synthetic::advance_clocks(config.clock, 1.0, &truth.clocks, &noise);
    follow(rate_b);
    filter.predict(block, state.time);
    if (second < kOpen)
      filter.update(
          synthetic::measure(state.time, synthetic::eight_satellites(), truth, 1.0, 0.05, &noise));
  }
  const Vector3d error = state.p_e - filter.state().p_e;
  const Eigen::Matrix3d P = filter.covariance().block<3, 3>(kPosition, kPosition);
  outcome.error_m = error.norm();
  outcome.sigma_m = std::sqrt(P.trace());
  outcome.nees_position = error.dot(P.inverse() * error);
  return outcome;
}

}  // namespace

TEST_CASE("samples lost one by one hardly change where the filter leaves a tunnel") {
  constexpr int kRuns = 5;
  double error2_whole = 0.0, sigma_whole = 0.0;
  for (int run = 0; run < kRuns; ++run) {
    const TunnelOutcome whole = tunnel(0.0, 1, 40 + static_cast<std::uint64_t>(run));
    error2_whole += whole.error_m * whole.error_m;
    sigma_whole = std::max(sigma_whole, whole.sigma_m);
  }
  for (const double loss : {0.002, 0.02}) {
    double error2 = 0.0, sigma = 0.0;
    int lost = 0;
    for (int run = 0; run < kRuns; ++run) {
      const TunnelOutcome holed = tunnel(loss, 1, 40 + static_cast<std::uint64_t>(run));
      error2 += holed.error_m * holed.error_m;
      sigma = std::max(sigma, holed.sigma_m);
      lost += holed.lost;
      CHECK(holed.nees_position < 16.3);  // 99.9 % of a chi-square with 3 degrees
    }
    WARN("60 s tunnel, " << 100.0 * loss << " % lost: " << std::sqrt(error2 / kRuns) << " m (sigma "
                         << sigma << " m); none lost: " << std::sqrt(error2_whole / kRuns)
                         << " m (sigma " << sigma_whole << " m)");
    CHECK(lost > 0.5 * loss * kRuns * 180 * kPerSecond);
    CHECK(std::sqrt(error2) < 1.3 * std::sqrt(error2_whole));
    CHECK(sigma < 1.5 * sigma_whole);
  }
}

TEST_CASE("a tenth of a second lost at a time is bridged within its stated sigma") {
  for (std::uint64_t seed = 60; seed < 64; ++seed) {
    const TunnelOutcome outcome = tunnel(2e-4, 20, seed);
    WARN("holes of 0.1 s, " << outcome.lost << " samples lost: " << outcome.error_m << " m (sigma "
                            << outcome.sigma_m << " m)");
    CHECK(outcome.lost >= 20);
    CHECK(outcome.nees_position < 16.3);
  }
}

}  // namespace leonav
