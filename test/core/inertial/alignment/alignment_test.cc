#include "core/inertial/alignment/alignment.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <numbers>

#include "core/base/angle.h"
#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"
#include "exact_motion.h"
#include "support/catch.h"
#include "support/recorded/shared_data.h"

using namespace leonav;
using namespace leonav::test;

namespace {

constexpr double kDt = 0.01;
const Geodetic kWhere{40.0 * kDegree, -105.0 * kDegree, 1600.0};
const Eigen::Matrix3d kC_en = rotation_ecef_to_ned(kWhere).transpose();
const Eigen::Vector3d kPosition = to_ecef(kWhere);
const Eigen::Vector3d kGyroBias(0.002, -0.003, 0.001);
ImuErrorModel imu_model() {
  ImuErrorModel imu;
  imu.angle_random_walk = 1e-5;
  imu.gyro_bias.sigma = 0.005;
  return imu;
}
const ImuErrorModel kImu = imu_model();

// A vehicle on a plane: stands, speeds up along its x axis, drives on. Roll and pitch stay (tilted
// mounting), the body shakes while it moves.
struct Ride {
  EulerAngles angles;
  double speed = 0.0, acceleration = 0.0, yaw_rate = 0.0, shake = 0.0, t = 0.0;
  GpsTime time = GpsTime::from_week_and_tow(2400, 0.0);

  Eigen::Vector3d v_e() const {
    const Eigen::Vector3d v_n(speed * std::cos(angles.yaw), speed * std::sin(angles.yaw), 0.0);
    return kC_en * v_n;
  }
  Eigen::Quaterniond q_eb() const {
    return Eigen::Quaterniond(Eigen::Matrix3d(kC_en * rotation_from_euler(angles)));
  }
  ImuSample step() {
    t += kDt;
    speed += acceleration * kDt;
    angles.yaw = wrap_to_pi(angles.yaw + yaw_rate * kDt);
    time = time.plus_nanoseconds(10'000'000);
    const double c = std::cos(angles.yaw), s = std::sin(angles.yaw);
    const double sway = shake * std::sin(2.0 * std::numbers::pi * 2.0 * t);
    const double centripetal = speed * yaw_rate;
    const Eigen::Vector3d force_n(acceleration * c - centripetal * s - sway * s,
                                  acceleration * s + centripetal * c + sway * c,
                                  -9.80 + 1.5 * sway);
    const Eigen::Matrix3d C_nb = rotation_from_euler(angles);
    const Eigen::Vector3d omega_ie_b = q_eb().conjugate() * Eigen::Vector3d(0, 0, 7.292115e-5);
    ImuSample sample;
    sample.time = time;
    sample.interval_ns = 10'000'000;
    const Eigen::Vector3d rate =
        C_nb.transpose() * Eigen::Vector3d(0, 0, yaw_rate) + omega_ie_b + kGyroBias;
    sample.delta_theta_b = rate * kDt;
    sample.delta_velocity_b = C_nb.transpose() * force_n * kDt;
    return sample;
  }
};

void run(Ride* ride, Alignment* alignment, double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds / kDt)); ++i) {
    alignment->add(ride->step());
    // Once a second the GNSS gives a velocity, which may or may not yield an attitude.
    if (i % 100 == 99) (void)alignment->attitude(kPosition, ride->v_e(), 0.05);
  }
}

// Goes on until an epoch (one a second) yields an attitude.
std::optional<int> seconds_to_attitude(Ride* ride, Alignment* alignment, double sigma_v,
                                       int at_most) {
  for (int second = 1; second <= at_most; ++second) {
    for (int i = 0; i < 100; ++i) alignment->add(ride->step());
    if (alignment->attitude(kPosition, ride->v_e(), sigma_v)) return second;
  }
  return std::nullopt;
}

double tilt_error(const AlignedAttitude& aligned, const Ride& ride) {
  const Eigen::Vector3d error =
      rotation_vector_from_quaternion(ride.q_eb().conjugate() * aligned.q_eb);
  const Eigen::Vector3d error_n = rotation_from_euler(ride.angles) * error;
  return std::hypot(error_n.x(), error_n.y());
}

double heading_error(const AlignedAttitude& aligned, const Ride& ride) {
  const Eigen::Matrix3d C_nb = kC_en.transpose() * aligned.q_eb.toRotationMatrix();
  return std::abs(wrap_to_pi(euler_from_rotation(C_nb).yaw - ride.angles.yaw));
}

}  // namespace

namespace {

// What the levelling turns the heading by, until 6 s after driving off at t0. It is a running mean
// (gain 1 / (g t)): the push a tilts the level by a / g (t - t0) / t, the sway s sin(w t) rolls it
// by s / (g w) (1 - cos w t) / t, and rolling a pitched level turns it, psi' = tan(pitch) roll'.
// By parts between whole periods: psi(t2) - psi(t1) = a s t0 / (2 g^2 w) (1 / t2^2 - 1 / t1^2).
// The gyros carry the mean of the courses on: those of the last five epochs, weighted by their
// sigmas.
double turn_by_levelling(double push, double sway, double t0) {
  constexpr double kGravity = 9.81, kPulsation = 2.0 * std::numbers::pi * 2.0;
  const double factor = push * sway * t0 / (2.0 * kGravity * kGravity * kPulsation);
  const double now = t0 + 6.0;
  double sum = 0.0, weights = 0.0;
  for (int epoch = 2; epoch <= 6; ++epoch) {
    const double then = t0 + epoch;
    const double variance = std::pow(0.05 / (push * epoch), 2) + 0.03 * 0.03;
    sum += factor * (1.0 / (then * then) - 1.0 / (now * now)) / variance;
    weights += 1.0 / variance;
  }
  return sum / weights;
}

}  // namespace

TEST_CASE("Stand, then drive off: attitude and gyro bias in all four quadrants", "[ins]") {
  double worst_tilt = 0.0, worst_heading = 0.0, worst_bias = 0.0;
  const double expected_heading = turn_by_levelling(0.5, 1.5, 20.0);
  for (const double yaw_deg : {0.0, 45.0, 135.0, 180.0, -135.0, -45.0, -90.0}) {
    for (const EulerAngles& mounting :
         {EulerAngles{0, 0, 0}, EulerAngles{0.25, -0.3, 0}, EulerAngles{-0.6, 0.4, 0}}) {
      Ride ride{{mounting.roll, mounting.pitch, yaw_deg * kDegree}};
      Alignment alignment({}, kImu);
      run(&ride, &alignment, 20.0);
      CHECK(alignment.levelled());
      CHECK_FALSE(alignment.attitude(kPosition, ride.v_e(), 0.05));  // no course yet
      ride.acceleration = 0.5;
      ride.shake = 1.5;
      run(&ride, &alignment, 6.0);  // above 1 m/s after two, and three to be sure
      const auto aligned = alignment.attitude(kPosition, ride.v_e(), 0.05);
      REQUIRE(aligned);
      worst_tilt = std::max(worst_tilt, tilt_error(*aligned, ride));
      // A tilted mounting adds up to 4e-7 of third order (without the sway it is all there is).
      CHECK(heading_error(*aligned, ride) == Approx(expected_heading).margin(4e-7));
      worst_heading = std::max(worst_heading, heading_error(*aligned, ride));
      CHECK(aligned->gyro_bias_known);
      worst_bias = std::max(worst_bias, (aligned->gyro_bias_b - kGyroBias).norm());
    }
  }
  std::cout << "alignment after a standstill: tilt " << worst_tilt / kDegree << " deg, heading "
            << worst_heading << " rad (by the levelling " << expected_heading << "), gyro bias "
            << worst_bias << " rad/s\n";
  CHECK(worst_tilt < 0.035);  // levelling_sigma: 2 deg
  CHECK(worst_bias < 1e-5);   // below the Earth's rate: that was told apart
}

TEST_CASE("Started on the move, shaking: levelled, heading from the course", "[ins]") {
  double worst_tilt = 0.0;
  for (const double yaw_deg : {30.0, 120.0, -150.0, -60.0}) {
    Ride ride{{0.1, -0.2, yaw_deg * kDegree}};
    ride.speed = 3.0;
    ride.shake = 2.0;
    Alignment alignment({}, kImu);
    run(&ride, &alignment, 30.0);
    const auto aligned = alignment.attitude(kPosition, ride.v_e(), 0.05);
    REQUIRE(aligned);
    worst_tilt = std::max(worst_tilt, tilt_error(*aligned, ride));
    CHECK_FALSE(aligned->gyro_bias_known);
    CHECK(aligned->sigma_rpy.z() == Approx(std::hypot(0.05 / 3.0, 0.03)).epsilon(0.01));
  }
  std::cout << "alignment on the move: tilt " << worst_tilt / kDegree << " deg\n";
  CHECK(worst_tilt < 0.07);
}

TEST_CASE("Steady motion is no standstill", "[ins]") {
  // Smooth as a standstill to the IMU, in a gentle curve: only the velocity tells.
  Ride ride{{0.0, 0.0, 1.0}};
  ride.speed = 10.0;
  ride.yaw_rate = 0.02;
  Alignment alignment({}, kImu);
  run(&ride, &alignment, 20.0);
  const auto aligned = alignment.attitude(kPosition, ride.v_e(), 0.05);
  REQUIRE(aligned);
  CHECK_FALSE(aligned->gyro_bias_known);
  CHECK(aligned->gyro_bias_b.isZero());
}

TEST_CASE("Turned in place before it drives off: no bias is made of the turn", "[ins]") {
  // Slower than what counts as standing, and seen by no antenna on the axis it turns about.
  for (const double rate : {0.009, 0.035}) {  // rad/s: 0.5 and 2 deg/s
    CAPTURE(rate);
    Ride ride{{0.0, 0.0, 0.5}};
    Alignment alignment({}, kImu);
    run(&ride, &alignment, 20.0);
    ride.yaw_rate = rate;
    run(&ride, &alignment, 10.0);
    ride.yaw_rate = 0.0;
    ride.acceleration = 0.5;
    run(&ride, &alignment, 6.0);
    const auto aligned = alignment.attitude(kPosition, ride.v_e(), 0.05);
    REQUIRE(aligned);
    REQUIRE(aligned->gyro_bias_known);
    const Eigen::Vector3d error = aligned->gyro_bias_b - kGyroBias;
    std::cout << "turned at " << rate << " rad/s: gyro bias off by " << error.norm()
              << " rad/s, stated " << aligned->gyro_bias_sigma << "\n";
    CHECK(error.norm() < 3.0 * aligned->gyro_bias_sigma);
    CHECK(heading_error(*aligned, ride) < 3.0 * aligned->sigma_rpy.z());
  }
}

TEST_CASE("A given heading needs no motion", "[ins]") {
  const ExternalHeading::Heading given{-2.0, 0.05};
  Ride ride{{0.3, 0.1, -2.0}};
  Alignment alignment({}, kImu);
  CHECK_FALSE(alignment.attitude(kPosition, ride.v_e(), 0.05, given));  // not levelled
  run(&ride, &alignment, 3.0);
  const auto aligned = alignment.attitude(kPosition, ride.v_e(), 0.05, given);
  REQUIRE(aligned);
  CHECK(heading_error(*aligned, ride) < 1e-6);
  CHECK(tilt_error(*aligned, ride) < 0.01);
  CHECK(aligned->sigma_rpy.z() == given.sigma);
  alignment.reset();
  CHECK_FALSE(alignment.levelled());
}

TEST_CASE("No attitude from a slow or uncertain course, nor from a dead sensor", "[ins]") {
  Ride ride{{0.0, 0.0, 0.5}};
  ride.speed = 0.5;
  Alignment alignment({}, kImu);
  run(&ride, &alignment, 5.0);
  CHECK_FALSE(alignment.attitude(kPosition, ride.v_e(), 0.01));
  ride.speed = 2.0;
  CHECK_FALSE(seconds_to_attitude(&ride, &alignment, 1.0, 10));
  CHECK_FALSE(seconds_to_attitude(&ride, &alignment, std::nan(""), 10));
  // The first of the four epochs that three seconds take, and the one its turn rate needs.
  CHECK(seconds_to_attitude(&ride, &alignment, 0.1, 10) == 4);

  Alignment dead({}, kImu);
  ImuSample zero;
  zero.interval_ns = 10'000'000;
  for (int i = 0; i < 1000; ++i) dead.add(zero);
  CHECK_FALSE(dead.levelled());
}

namespace {

struct HandMotion {
  double yaw_rate, course_rate, course_minus_yaw, speed;
};

// A device moved by hand: its antenna goes where the hand takes it, which need not be where the
// device points. 4 Hz as the recorded walk.
std::optional<double> hand_alignment_error(const HandMotion& motion, double seconds, Ride* ride,
                                           Alignment* alignment) {
  double course = wrap_to_pi(ride->angles.yaw + motion.course_minus_yaw);
  ride->yaw_rate = motion.yaw_rate;
  for (int i = 1; i <= static_cast<int>(std::lround(seconds / kDt)); ++i) {
    alignment->add(ride->step());
    course = wrap_to_pi(course + motion.course_rate * kDt);
    if (i % 25 != 0) continue;
    const Eigen::Vector3d v_n(motion.speed * std::cos(course), motion.speed * std::sin(course),
                              0.0);
    const auto aligned = alignment->attitude(kPosition, kC_en * v_n, 0.1);
    if (aligned) return heading_error(*aligned, *ride) / aligned->sigma_rpy.z();
  }
  return std::nullopt;
}

}  // namespace

TEST_CASE("Picked up, turned or swung: no false alignment; then walked: a true one", "[ins]") {
  const HandMotion before[] = {
      {1.5, 0.0, 1.5, 1.2},    // turned while carried straight
      {-1.0, 0.0, -0.5, 0.9},  // the other way
      {0.0, 1.0, 0.3, 1.5},    // carried around a bend without turning
      {1.6, 1.6, 1.571, 0.8},  // swung at half a metre: course at right angles, consistently
      {-2.0, -2.0, -1.571, 1.0},
  };
  double worst = 0.0;
  for (const HandMotion& motion : before) {
    Ride ride{{0.05, 0.1, 2.0}};
    Alignment alignment({}, kImu);
    run(&ride, &alignment, 5.0);
    CHECK_FALSE(hand_alignment_error(motion, 8.0, &ride, &alignment));
    // Straight on, the course off the heading by 1 sigma: aligned after the three seconds it needs
    // to be sure.
    const auto error = hand_alignment_error({0.0, 0.0, 0.03, 1.3}, 8.0, &ride, &alignment);
    REQUIRE(error);
    worst = std::max(worst, *error);
  }
  std::cout << "alignment after hand motion: heading error at most " << worst << " sigma\n";
  CHECK(worst < 2.0);
}

TEST_CASE("Short or interrupted motion is no evidence", "[ins]") {
  Ride ride{{0.0, 0.0, 0.5}};
  Alignment alignment({}, kImu);
  run(&ride, &alignment, 3.0);
  for (int push = 0; push < 5; ++push) {
    CHECK_FALSE(hand_alignment_error({0.0, 0.0, 1.0, 1.5}, 2.5, &ride, &alignment));
    CHECK_FALSE(hand_alignment_error({0.0, 0.0, 1.0, 0.1}, 0.5, &ride, &alignment));
  }
}

TEST_CASE("A hole in the samples costs no turn if short, and a new start if long", "[ins]") {
  const auto skip = [](Ride* ride, double seconds) {
    for (int i = 0; i < static_cast<int>(std::lround(seconds / kDt)); ++i) ride->step();
  };
  for (const double hole_s : {0.1, 0.3, 20.0}) {
    CAPTURE(hole_s);
    Ride ride{{0.0, 0.0, 0.5}};
    Alignment alignment({}, kImu);
    run(&ride, &alignment, 10.0);
    ride.speed = 5.0;
    REQUIRE(seconds_to_attitude(&ride, &alignment, 0.05, 10) == 4);
    // Somewhere in the hole it turns at 1 rad/s, and goes on turning.
    ride.yaw_rate = 1.0;
    run(&ride, &alignment, 0.1);
    skip(&ride, hole_s);
    run(&ride, &alignment, 0.5);
    ride.yaw_rate = 0.0;
    const bool bridged = hole_s <= 0.2;
    CHECK(alignment.levelled() == bridged);
    const auto waited = seconds_to_attitude(&ride, &alignment, 0.05, 20);
    REQUIRE(waited);
    CHECK((*waited >= 4) == !bridged);
    const auto aligned = alignment.attitude(kPosition, ride.v_e(), 0.05);
    REQUIRE(aligned);
    // Bridged: the window may still hold courses of before, and the gap fill is an estimate. Anew:
    // the gyro bias is unknown, and the mean course is two seconds old.
    CHECK(heading_error(*aligned, ride) < (bridged ? 0.01 : 2.5 * kGyroBias.norm()));
    CHECK(aligned->gyro_bias_known == bridged);
  }
}
