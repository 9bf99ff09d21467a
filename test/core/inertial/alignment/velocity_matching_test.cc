// Heading from velocity matching: as good as it says, in curves, speeding up and in reverse; silent
// where nothing changes or nothing fits. And the alignment that makes use of it.
#include "core/inertial/alignment/velocity_matching.h"

#include <functional>
#include <optional>

#include "core/base/angle.h"
#include "core/inertial/alignment/alignment.h"
#include "support/catch.h"
#include "synthetic_vehicle.h"

namespace leonav {
namespace {

using test::SyntheticVehicle;

constexpr double kSigma = 0.05;

// Acceleration and curvature at a second.
using Way = std::function<Eigen::Vector2d(int)>;
const Way kCurve = [](int) { return Eigen::Vector2d(0.0, 0.04); };
const Way kSpeedUp = [](int t) { return Eigen::Vector2d(t < 4 ? 1.5 : 0.2, 0.0); };
const Way kBackOut = [](int t) { return Eigen::Vector2d(t < 4 ? -0.5 : t < 6 ? 0.8 : -0.3, 0.1); };
const Way kSteady = [](int) { return Eigen::Vector2d(0.0, 0.0); };

struct Outcome {
  std::optional<VelocityMatching::Match> match;
  double error = 0.0;
};

Outcome run(const ImuErrorModel& imu, const Way& way, double speed, std::uint64_t seed,
            double wrong_velocity = 0.0, int samples_per_velocity = 100) {
  SyntheticVehicle vehicle(imu, 0.1 * static_cast<double>(seed), seed);
  for (int i = 0; i < 1000; ++i) (void)vehicle.step(speed / 10.0, 0.0);
  VelocityMatching::Config config;
  config.accel_bias_sigma = imu.accel_bias.sigma;
  VelocityMatching matching(config);
  // Levelled to two degrees, its heading of another zero.
  Eigen::Quaterniond q_lb(rotation_from_euler({0.02, -0.03, vehicle.yaw() + 1.0}));
  for (int i = 1; i <= 1430; ++i) {
    const int t = (i - 1) / 100;
    const Eigen::Vector2d a = way(t);
    const ImuSample sample = vehicle.step(a.x(), a.y());
    matching.add(sample);
    q_lb = q_lb * quaternion_from_rotation_vector(sample.delta_theta_b);
    if (i % samples_per_velocity != 0) continue;
    const Eigen::Vector2d off(t % 4 < 2 ? wrong_velocity : -wrong_velocity, wrong_velocity);
    matching.add_velocity(vehicle.v_n(kSigma) + off, kSigma, q_lb);
  }
  const auto match = matching.match(imu.gyro_bias.sigma);
  if (!match) return {};
  return {match, wrap_to_pi(match->heading.heading - vehicle.yaw())};
}

TEST_CASE("velocity matching finds the heading in curves, speeding up and in reverse, as it says") {
  for (const ImuErrorModel& imu : {test::tactical_imu(), test::mems_imu()}) {
    for (const Way* way : {&kCurve, &kSpeedUp, &kBackOut}) {
      double squares = 0.0, worst_ratio = 0.0;
      constexpr int kRuns = 60;
      for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
        const Outcome outcome = run(imu, *way, way == &kBackOut ? 0.0 : 6.0, seed);
        REQUIRE(outcome.match);
        const double ratio = outcome.error / outcome.match->heading.sigma;
        squares += ratio * ratio;
        worst_ratio = std::max(worst_ratio, std::abs(ratio));
      }
      INFO("over sigma rms " << std::sqrt(squares / kRuns) << ", worst " << worst_ratio);
      CHECK(squares / kRuns < 1.3);
      CHECK(worst_ratio < 4.0);
    }
  }
}

// Between the velocities that its window takes the vehicle turns on: by ten degrees here.
TEST_CASE("velocity matching tells the heading at the last sample, however fast velocities come") {
  const Way bend = [](int) { return Eigen::Vector2d(0.0, 0.08); };
  for (const int samples : {10, 20, 50, 100}) {
    CAPTURE(samples);
    double worst_ratio = 0.0;
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Outcome outcome = run(test::tactical_imu(), bend, 6.0, seed, 0.0, samples);
      REQUIRE(outcome.match);
      worst_ratio = std::max(worst_ratio, std::abs(outcome.error) / outcome.match->heading.sigma);
    }
    CHECK(worst_ratio < 4.0);
  }
}

TEST_CASE("steady driving, and velocities of reflected signals, match nothing") {
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    CHECK_FALSE(run(test::mems_imu(), kSteady, 8.0, seed).match);
    CHECK_FALSE(run(test::tactical_imu(), kSteady, 8.0, seed).match);
    CHECK_FALSE(run(test::tactical_imu(), kCurve, 6.0, seed, 2.0).match);
  }
}

// The heading's error when a car that backs out of its space is aligned; nullopt: not in 20 s.
std::optional<double> back_out(const ImuErrorModel& imu, bool matching, std::uint64_t seed) {
  AlignmentConfig config;
  config.velocity_matching = matching;
  config.max_reverse_speed_m_s = matching ? 5.0 : 0.0;
  config.max_gyrocompass_sigma = 0.0;
  Alignment alignment(config, imu);
  const Geodetic where{SyntheticVehicle::kLatitude, 0.3, 100.0};
  const Eigen::Matrix3d C_en = rotation_ecef_to_ned(where).transpose();
  SyntheticVehicle vehicle(imu, 0.2 * static_cast<double>(seed), seed);
  for (int t = 0; t < 20; ++t) {
    const double acceleration = t < 5 ? 0.0 : t < 8 ? -0.6 : t < 16 ? 0.0 : 0.9;
    const double curvature = t < 10 ? 0.0 : 0.12;
    for (int i = 0; i < 100; ++i) alignment.add(vehicle.step(acceleration, curvature));
    const Eigen::Vector2d v_n = vehicle.v_n(kSigma);
    const auto aligned =
        alignment.attitude(to_ecef(where), C_en * Eigen::Vector3d(v_n.x(), v_n.y(), 0.0), kSigma);
    if (!aligned) continue;
    const Eigen::Matrix3d C_nb = C_en.transpose() * aligned->q_eb.toRotationMatrix();
    return wrap_to_pi(euler_from_rotation(C_nb).yaw - vehicle.yaw());
  }
  return std::nullopt;
}

TEST_CASE("a car that backs out of its space is not aligned the wrong way round") {
  int aligned = 0, wrong_by_course = 0;
  double worst = 0.0;
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    for (const ImuErrorModel& imu : {test::tactical_imu(), test::mems_imu()}) {
      const auto by_course = back_out(imu, false, seed);
      wrong_by_course += by_course && std::abs(*by_course) > 2.0 ? 1 : 0;
      const auto error = back_out(imu, true, seed);
      aligned += error ? 1 : 0;
      worst = std::max(worst, std::abs(error.value_or(0.0)));
    }
  }
  CHECK(wrong_by_course == 100);  // what the course alone makes of it
  CHECK(aligned >= 90);
  CHECK(worst < 20.0 * kDegree);
}

TEST_CASE(
    "a heading that another one follows is not taken, and one that stays is, a little later") {
  const Geodetic where{SyntheticVehicle::kLatitude, 0.3, 100.0};
  const Eigen::Matrix3d C_en = rotation_ecef_to_ned(where).transpose();
  struct Aligned {
    int after_s = 0;
    double sigmas = 0.0;
  };
  // By courses; those of the first seconds came by way of a wall.
  bool contradicted = false;
  const auto align = [&](double confirming_s, int bent_s) {
    contradicted = false;
    AlignmentConfig config;
    config.course_window_s = 4.0;
    config.max_gyrocompass_sigma = 0.0;
    config.confirming_s = confirming_s;
    Alignment alignment(config, test::tactical_imu());
    SyntheticVehicle vehicle(test::tactical_imu(), 0.5, 3);
    for (int t = 1; t <= 40; ++t) {
      for (int i = 0; i < 100; ++i) alignment.add(vehicle.step(0.0, 0.0));
      const double course = vehicle.yaw() + (t <= bent_s ? 25.0 * kDegree : 0.0);
      const Eigen::Vector3d v_n(8.0 * std::cos(course), 8.0 * std::sin(course), 0.0);
      const auto aligned = alignment.attitude(to_ecef(where), C_en * v_n, 0.05);
      if (!aligned) {
        if (const auto need = alignment.need(where.latitude); need.lacking == Lacking::kAgreement)
          contradicted = true;
        continue;
      }
      const Eigen::Matrix3d C_nb = C_en.transpose() * aligned->q_eb.toRotationMatrix();
      const double error = wrap_to_pi(euler_from_rotation(C_nb).yaw - vehicle.yaw());
      return Aligned{t, std::abs(error) / aligned->sigma_rpy.z()};
    }
    return Aligned{};
  };
  const Aligned at_once = align(0.0, 0), confirmed = align(2.0, 0);
  CHECK(confirmed.after_s == at_once.after_s + 2);
  CHECK(align(0.0, at_once.after_s).sigmas > 10.0);
  const Aligned bent = align(2.0, at_once.after_s);
  CHECK(contradicted);  // and it says so
  CHECK(bent.after_s > confirmed.after_s);
  CHECK(bent.sigmas < 2.0);
}

// Forty MEMS vehicles that drive straight on and have never stood still.
struct Forty {
  int aligned = 0;
  double worst = 0.0, mean_square = 0.0;  // heading error, rad, and over its sigma
};
// `has_velocity` at second t of what has lacked so far.
Forty align_forty(const AlignmentConfig& config, double speed,
                  const std::function<bool(int, AlignmentNeed)>& has_velocity) {
  const Geodetic where{SyntheticVehicle::kLatitude, 0.3, 100.0};
  const Eigen::Matrix3d C_en = rotation_ecef_to_ned(where).transpose();
  ImuErrorModel imu = test::mems_imu();
  imu.gyro_bias.sigma = 1800.0 * kDegree / 3600.0;
  Forty all;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Alignment alignment(config, imu);
    SyntheticVehicle vehicle(imu, 0.2 * static_cast<double>(seed), seed);
    for (int i = 0; i < 100; ++i) (void)vehicle.step(speed, 0.0);
    for (int t = 1; t <= 120; ++t) {
      for (int i = 0; i < 100; ++i) alignment.add(vehicle.step(0.0, 0.0));
      if (!has_velocity(t, alignment.need(where.latitude))) continue;
      const Eigen::Vector2d v_n = vehicle.v_n(kSigma);
      const auto found =
          alignment.attitude(to_ecef(where), C_en * Eigen::Vector3d(v_n.x(), v_n.y(), 0.0), kSigma);
      if (!found) continue;
      const Eigen::Matrix3d C_nb = C_en.transpose() * found->q_eb.toRotationMatrix();
      const double error = wrap_to_pi(euler_from_rotation(C_nb).yaw - vehicle.yaw());
      all.worst = std::max(all.worst, std::abs(error));
      all.mean_square += std::pow(error / found->sigma_rpy.z(), 2);
      ++all.aligned;
      break;
    }
  }
  all.mean_square /= std::max(1, all.aligned);
  return all;
}

// Gyros that have not stood still carry a heading on by their bias: that contradicts nothing.
TEST_CASE("gyros of an unknown bias are confirmed too, whatever the epochs") {
  AlignmentConfig config;
  config.velocity_matching = true;
  config.max_reverse_speed_m_s = 5.0;
  config.confirming_s = 3.0;
  for (const int epoch_s : {1, 10}) {
    CAPTURE(epoch_s);
    const Forty all =
        align_forty(config, 15.0, [=](int t, AlignmentNeed) { return t % epoch_s == 0; });
    CHECK(all.aligned >= 39);
    CHECK(all.mean_square < 2.0);
  }
}

TEST_CASE("what unknown gyros drift in a tunnel confirms nothing") {
  AlignmentConfig config;
  config.max_gyrocompass_sigma = 0.0;
  config.confirming_s = 3.0;
  int tunnel_from = 0;
  const Forty all = align_forty(config, 8.0, [&](int t, AlignmentNeed need) {
    if (t == 1) tunnel_from = 0;
    const bool candidate = need.lacking == Lacking::kCourse && need.seconds <= config.confirming_s;
    if (tunnel_from == 0 && candidate) tunnel_from = t;
    return tunnel_from == 0 || t >= tunnel_from + 60;
  });
  CHECK(all.aligned >= 39);
  CHECK(all.mean_square < 2.0);
  CHECK(all.worst < 5.0 * kDegree);
}

TEST_CASE("the seconds of driving that a heading still takes count down to none") {
  const Geodetic where{SyntheticVehicle::kLatitude, 0.3, 100.0};
  const Eigen::Matrix3d C_en = rotation_ecef_to_ned(where).transpose();
  AlignmentConfig config;
  config.course_window_s = 4.0;
  config.max_gyrocompass_sigma = 0.0;
  config.confirming_s = 3.0;
  Alignment alignment(config, test::tactical_imu());
  SyntheticVehicle vehicle(test::tactical_imu(), 0.5, 3);
  double before = 100.0;
  for (int t = 1; t <= 40; ++t) {
    for (int i = 0; i < 100; ++i) alignment.add(vehicle.step(0.0, 0.0));
    const Eigen::Vector3d v_n(8.0 * std::cos(vehicle.yaw()), 8.0 * std::sin(vehicle.yaw()), 0.0);
    if (alignment.attitude(to_ecef(where), C_en * v_n, 0.05)) {
      CHECK(before == Approx(1.0).margin(0.01));
      return;
    }
    if (t < 3) continue;
    const AlignmentNeed need = alignment.need(where.latitude);
    CAPTURE(t);
    CHECK(need.lacking == Lacking::kCourse);
    CHECK(need.seconds < before - 0.5);
    before = need.seconds;
  }
  FAIL("never aligned");
}

TEST_CASE("an alignment says what it lacks") {
  const Geodetic where{SyntheticVehicle::kLatitude, 0.3, 100.0};
  const auto lacking_after = [&](const ImuErrorModel& imu, int stands_s, int drives_s,
                                 double reverse) {
    AlignmentConfig config;
    config.velocity_matching = true;
    config.max_reverse_speed_m_s = reverse;
    config.course_window_s = 6.0;
    Alignment alignment(config, imu);
    SyntheticVehicle vehicle(imu, 0.5, 3);
    const Eigen::Matrix3d C_en = rotation_ecef_to_ned(where).transpose();
    for (int t = 0; t < stands_s + drives_s; ++t) {
      const bool drives = t >= stands_s;
      // At once: the accelerometers see nothing of it.
      for (int i = 0; i < 100; ++i) alignment.add(vehicle.step(0.0, 0.0));
      (void)alignment.attitude(to_ecef(where), C_en * Eigen::Vector3d(drives ? 4.0 : 0.0, 0.0, 0.0),
                               kSigma);
    }
    return alignment.need(where.latitude);
  };
  CHECK(lacking_after(test::mems_imu(), 0, 0, 0.0).lacking == Lacking::kLevelling);
  CHECK(lacking_after(test::mems_imu(), 10, 0, 0.0).lacking == Lacking::kDriving);
  const AlignmentNeed north = lacking_after(test::tactical_imu(), 5, 0, 0.0);
  CHECK(north.lacking == Lacking::kNorth);
  CHECK(north.seconds > 1.0);
  CHECK(north.seconds < 30.0);
  const AlignmentNeed course = lacking_after(test::mems_imu(), 3, 4, 0.0);
  CHECK(course.lacking == Lacking::kCourse);
  CHECK(course.seconds == Approx(3.0).margin(0.1));
  CHECK(lacking_after(test::mems_imu(), 3, 12, 5.0).lacking == Lacking::kGear);
}

TEST_CASE("an IMU whose specific force is not of gravity's length is said to be") {
  Alignment alignment(AlignmentConfig(), test::mems_imu());
  for (int i = 1; i <= 150; ++i) {
    ImuSample sample;
    sample.interval_ns = 10'000'000;
    sample.time = GpsTime::from_week_and_tow(2400, 0.0).plus_nanoseconds(i * 10'000'000LL);
    sample.delta_velocity_b = Eigen::Vector3d(0.0, 0.0, -0.01);  // in g
    alignment.add(sample);
  }
  CHECK(alignment.need(0.7).lacking == Lacking::kGravity);
}

}  // namespace
}  // namespace leonav
