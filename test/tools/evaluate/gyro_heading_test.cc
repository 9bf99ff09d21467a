#include "tools/evaluate/internal/gyro_heading.h"

#include <cmath>

#include "core/base/angle.h"
#include "core/earth/rotation.h"
#include "support/catch.h"

using namespace leonav;

namespace {

constexpr double kDelay_s = 0.4, kDrift = 0.2 * kDegree;

// Ten seconds straight, ten seconds of a slalom, and so on, over several rounds.
double course_of(double t) {
  const double phase = std::fmod(t, 20.0);
  const double slalom = phase < 10.0 ? 0.0 : std::pow(std::sin((phase - 10.0) * 0.314159265), 2);
  return 0.9 * slalom * std::sin(2.0 * phase);
}

struct Recording {
  Track truth;
  std::vector<ImuSample> imu;
};

// The heading follows the course `kDelay_s` later, the gyros drift and the device is tilted.
Recording record() {
  Recording out;
  const GpsTime start = GpsTime::from_week_and_tow(2400, 100.0);
  for (int i = 0; i <= 400; ++i) {
    TrackPoint point;
    const double t = 0.25 * i;
    point.time = start.plus_nanoseconds(250'000'000LL * i);
    point.position = {0.7, -1.8, 100.0};
    point.v_n = Eigen::Vector3d(1.3 * std::cos(course_of(t)), 1.3 * std::sin(course_of(t)), 0.0);
    out.truth.push_back(point);
  }
  const Eigen::Matrix3d C_bn = rotation_from_euler({0.3, -0.2, 0.0}).transpose();
  for (int i = 1; i <= 10000; ++i) {
    const double t = 0.01 * i;
    ImuSample sample;
    sample.time = start.plus_nanoseconds(10'000'000LL * i);
    sample.interval_ns = 10'000'000;
    const double turn = course_of(t - kDelay_s) - course_of(t - 0.01 - kDelay_s) + kDrift * 0.01;
    sample.delta_theta_b = C_bn * Eigen::Vector3d(0.0, 0.0, turn);
    sample.delta_velocity_b = C_bn * Eigen::Vector3d(0.0, 0.0, -0.0981);
    out.imu.push_back(sample);
  }
  return out;
}

}  // namespace

TEST_CASE("the gyros' bound finds delay and drift, and none of it where the course is steady") {
  const Recording recording = record();
  ErrorOptions options;
  options.max_course_rate = 2.0 * kDegree;
  const GyroHeading gyro = evaluate_gyro_heading(recording.imu, recording.truth, options);
  CHECK(gyro.best_delay_s == Approx(kDelay_s));
  CHECK(gyro.at_best_delay.rmse < 0.3 * kDegree);
  CHECK(gyro.drift_rad_s == Approx(kDrift).margin(0.02 * kDegree));
  CHECK(gyro.at_once.rmse > 8.0 * kDegree);
  CHECK(gyro.steady.count > 60);
  CHECK(gyro.steady.count < 250);
  CHECK(gyro.steady.rmse < 0.3 * gyro.at_once.rmse);

  options.course_speed_m_s = 2.0;  // nothing is that fast
  CHECK_THROWS_WITH(evaluate_gyro_heading(recording.imu, recording.truth, options),
                    Catch::Contains("no common time"));
}

TEST_CASE("yaw is judged apart where the course is steady") {
  const Recording recording = record();
  Track solution = recording.truth;
  for (TrackPoint& point : solution) {
    // Wrong by half a radian wherever the course turns, and by 0.05 everywhere.
    const double t = seconds_between(point.time, recording.truth.front().time);
    const bool turning = std::fmod(t, 20.0) >= 10.0;
    point.rpy[2] = course_of(t) + 0.05 + (turning ? 0.5 : 0.0);
  }
  ErrorOptions options;
  const Evaluation without = evaluate("x", solution, recording.truth, options, 3.0);
  CHECK_FALSE(without.yaw_steady);
  CHECK(without.yaw->rmse > 0.3);
  options.max_course_rate = 1e-6;
  const Evaluation with = evaluate("x", solution, recording.truth, options, 3.0);
  REQUIRE(with.yaw_steady);
  CHECK(with.yaw_steady->mean == Approx(0.05));
  CHECK(with.yaw_steady->rmse == Approx(0.05));
  CHECK(with.yaw->rmse == Approx(without.yaw->rmse));
}
