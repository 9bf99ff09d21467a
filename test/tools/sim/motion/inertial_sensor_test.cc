// What the simulated sensor does to a perfect one's samples.
#include "tools/sim/motion/inertial_sensor.h"

#include <cmath>
#include <iostream>
#include <numbers>

#include "core/base/angle.h"
#include "core/earth/rotation.h"
#include "core/inertial/strapdown/mechanization.h"
#include "support/catch.h"
#include "tools/sim/motion/ideal_imu.h"
#include "tools/sim/route/drive.h"
#include "tools/sim/scenario/scenario_yaml.h"

using namespace leonav;
using namespace leonav::sim;

namespace {

constexpr double kRate = 200.0;
constexpr std::int64_t kInterval = 5'000'000;

InertialSensor sensor_of(const ImuErrorModel& model, const ImuImperfections& imperfections,
                         std::uint64_t seed = 1) {
  return {model, imperfections, kRate, seed, GaussianGenerator(77 + seed)};
}

ImuSample still() {
  ImuSample sample;
  sample.interval_ns = kInterval;
  sample.delta_velocity_b = {0.0, 0.0, -9.8 / kRate};
  return sample;
}

// Overlapping Allan deviation of a rate, from its increments (IEEE Std 952-1997, annex C).
double allan_deviation(const std::vector<double>& increments, double tau_s) {
  std::vector<double> angle{0.0};
  for (const double step : increments) angle.push_back(angle.back() + step);
  const auto m = static_cast<std::size_t>(std::lround(tau_s * kRate));
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i + 2 * m < angle.size(); ++i, ++count) {
    const double difference = angle[i + 2 * m] - 2.0 * angle[i + m] + angle[i];
    sum += difference * difference;
  }
  return std::sqrt(0.5 * sum / static_cast<double>(count)) / tau_s;
}

// Allan variance of a Gauss-Markov process at times far below its correlation time (same annex:
// a random walk of rate).
double drift(const GaussMarkov& bias, double tau_s) {
  return 2.0 * bias.sigma * bias.sigma / bias.correlation_time_s * tau_s / 3.0;
}

NavState state_at(const SplineMotion& motion) {
  const MotionInstant now = motion.at(0.0);
  NavState state;
  state.time = motion.start();
  state.p_e = now.p_e;
  state.v_e = now.v_e;
  state.q_eb = now.q_eb;
  return state;
}

}  // namespace

TEST_CASE("The noise-free IMU of a drive leads back along it within a centimetre", "[sim]") {
  for (const char* text : {"duration_s: 602\nroute: {standing_s: 20}",
                           "duration_s: 602\nroute: {standing_s: 20, vehicle: uav}"}) {
    for (const int seed : {1, 2, 3}) {
      const Scenario scenario =
          load_scenario_text(text, "test.yaml", {"seed=" + std::to_string(seed)});
      const SplineMotion motion = drive(scenario);
      Mechanization mechanization;
      mechanization.reset(state_at(motion));
      double worst = 0.0, turned = 0.0, fastest = 0.0;
      for (int i = 0; i < 600 * static_cast<int>(kRate); ++i) {
        const ImuSample sample = ideal_sample(motion, mechanization.state().time, kInterval);
        mechanization.advance(sample);
        turned += std::abs(sample.delta_theta_b.z());
        if (i % 20 != 0) continue;
        const MotionInstant now =
            motion.at(seconds_between(mechanization.state().time, motion.start()));
        worst = std::max(worst, (mechanization.state().p_e - now.p_e).norm());
        fastest = std::max(fastest, now.v_e.norm());
      }
      std::cout << "noise-free IMU, "
                << (scenario.route.vehicle == VehicleKind::kUav ? "UAV" : "car") << " seed " << seed
                << ": " << worst << " m after 600 s, up to " << fastest << " m/s, turned by "
                << turned / kDegree << " deg\n";
      CHECK(turned > 2.0 * std::numbers::pi);
      CHECK(worst < 0.01);
    }
  }
}

TEST_CASE("The noise at standstill has the data sheet's Allan deviation", "[sim]") {
  for (const ImuGrade grade : {ImuGrade::kTactical, ImuGrade::kMems}) {
    const ImuErrorModel model = errors_of(grade);
    std::vector<double> gyro[3], accel[3];
    InertialSensor sensor = sensor_of(model, {});
    for (int i = 0; i < 7200 * static_cast<int>(kRate); ++i) {
      const ImuSample sample = sensor.measure(still(), 0.0);
      for (Eigen::Index axis = 0; axis < 3; ++axis) {
        gyro[axis].push_back(sample.delta_theta_b[axis]);
        accel[axis].push_back(sample.delta_velocity_b[axis]);
      }
    }
    for (const double tau : {0.1, 1.0}) {
      double gyro_sum = 0.0, accel_sum = 0.0;
      for (int axis = 0; axis < 3; ++axis) {
        gyro_sum += std::pow(allan_deviation(gyro[axis], tau), 2) / 3.0;
        accel_sum += std::pow(allan_deviation(accel[axis], tau), 2) / 3.0;
      }
      const bool tactical = grade == ImuGrade::kTactical;
      const double arw = std::sqrt((gyro_sum - drift(model.gyro_bias, tau)) * tau) / kDegree * 60.0;
      const double vrw = std::sqrt((accel_sum - drift(model.accel_bias, tau)) * tau) * 60.0;
      std::cout << (tactical ? "tactical" : "mems") << ", Allan deviation at " << tau
                << " s: " << arw << " deg/sqrt(h), " << vrw << " m/s/sqrt(h) of noise\n";
      CHECK(arw == Approx(tactical ? 0.05 : 0.3).epsilon(0.05));
      CHECK(vrw == Approx(0.1).epsilon(0.05));
    }
  }
}

TEST_CASE("Vibration has its size and band, grows with speed and moves nothing", "[sim]") {
  ImuImperfections imperfections;
  imperfections.vibration = {0.1, 0.02, 0.001, 0.0, 20.0, 40.0};
  InertialSensor sensor = sensor_of({}, imperfections);
  for (const double speed : {0.0, 15.0}) {
    std::vector<double> shaking;
    double sum = 0.0, velocity = 0.0, farthest = 0.0;
    for (int i = 0; i < 60'000; ++i) {
      const ImuSample sample = sensor.measure(still(), speed);
      shaking.push_back(sample.delta_velocity_b.x() * kRate);
      sum += shaking.back() * shaking.back();
      velocity += sample.delta_velocity_b.x();
      farthest = std::max(farthest, std::abs(velocity));
    }
    const double rms = std::sqrt(sum / 60'000.0);
    CHECK(rms == Approx(0.1 + 0.02 * speed).epsilon(0.05));
    CHECK(farthest <
          0.02 * (1.0 + speed));  // white noise of this size would reach metres per second
    const auto power_at = [&](double hz) {
      double c = 0.0, s = 0.0, power = 0.0;
      for (std::size_t i = 0; i < shaking.size(); ++i) {
        const double phase = 2.0 * std::numbers::pi * hz * static_cast<double>(i) / kRate;
        const double window =
            1.0 - std::cos(2.0 * std::numbers::pi * static_cast<double>(i) / 1000.0);
        c += window * shaking[i] * std::cos(phase);
        s += window * shaking[i] * std::sin(phase);
        if ((i + 1) % 1000 != 0) continue;  // periodograms of 5 s, averaged
        power += c * c + s * s;
        c = s = 0.0;
      }
      return power;
    };
    CHECK(power_at(28.4) > 5.0 * power_at(8.0));
    CHECK(power_at(28.4) > 5.0 * power_at(80.0));
    CHECK(power_at(0.4) < 1e-3 * power_at(28.4));
  }
}

TEST_CASE("Axes lean, converters step, biases follow the temperature", "[sim]") {
  ImuImperfections leaning;
  leaning.accel_misalignment = 0.1 * kDegree;
  double sum = 0.0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const ImuSample sample = sensor_of({}, leaning, seed).measure(still(), 0.0);
    sum += sample.delta_velocity_b.head<2>().squaredNorm() / 800.0;
    CHECK(sample.delta_velocity_b.z() == still().delta_velocity_b.z());
  }
  CHECK(std::sqrt(sum) * kRate / 9.8 == Approx(0.1 * kDegree).epsilon(0.08));

  ImuImperfections steps;
  steps.accel_quantum = 0.01;
  InertialSensor coarse = sensor_of({}, steps);
  double total = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double given = coarse.measure(still(), 0.0).delta_velocity_b.z();
    CHECK(std::abs(given / 0.01 - std::round(given / 0.01)) < 1e-9);
    total += given;
  }
  CHECK(total == Approx(-9.8 * 5.0).margin(0.01));  // nothing is lost

  ImuImperfections warm;
  warm.temperature_rise_k = 20.0;
  warm.temperature_time_s = 100.0;
  warm.gyro_bias_per_k = 1e-6;
  double late = 0.0, middle = 0.0;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    InertialSensor sensor = sensor_of({}, warm, seed);
    CHECK(sensor.measure(still(), 0.0).delta_theta_b.norm() == 0.0);
    for (int i = 0; i < 20'000; ++i) sensor.measure(still(), 0.0);
    middle += sensor.measure(still(), 0.0).delta_theta_b.squaredNorm() / 150.0;
    for (int i = 0; i < 100'000; ++i) sensor.measure(still(), 0.0);
    late += sensor.measure(still(), 0.0).delta_theta_b.squaredNorm() / 150.0;
  }
  CHECK(std::sqrt(late) * kRate == Approx(20e-6).epsilon(0.2));
  CHECK(std::sqrt(middle / late) == Approx(1.0 - std::exp(-1.0)).epsilon(0.01));
}

TEST_CASE("Grades by name; keys that are given win", "[sim]") {
  const auto imu = [](const std::string& text) {
    return load_scenario_text("imu: {" + text + "}", "test.yaml").imu;
  };
  CHECK(imu("").errors.gyro_bias.sigma == Approx(0.5 * kDegree / 3600.0));
  CHECK(imu("grade: tactical").errors.accel_bias.sigma == Approx(25e-5));
  CHECK(imu("grade: mems").errors.gyro_bias.sigma == Approx(1000.0 * kDegree / 3600.0));
  CHECK(imu("gyro_bias_deg_per_h: 7, grade: mems").errors.gyro_bias.sigma ==
        Approx(7.0 * kDegree / 3600.0));
  CHECK(imu("grade: ideal").errors.angle_random_walk == 0.0);
  InertialSensor ideal = sensor_of(imu("grade: ideal").errors, {});
  CHECK(ideal.measure(still(), 0.0).delta_velocity_b == still().delta_velocity_b);
  CHECK_THROWS_WITH(imu("grade: navigation"), Catch::Contains("tactical, mems, ideal"));
  CHECK_THROWS_WITH(imu("vibration: {accel_idle_m_s2: 1, high_hz: 120}"),
                    Catch::Contains("below half of imu.rate_hz"));
  CHECK_THROWS_WITH(imu("vibration: {low_hz: 50}"), Catch::Contains("greater than low_hz"));
}
