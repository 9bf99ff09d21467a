#include "core/inertial/strapdown/mechanization.h"

#include <cmath>
#include <iostream>
#include <numbers>

#include "core/base/angle.h"
#include "core/earth/rotation.h"
#include "exact_motion.h"
#include "support/catch.h"

using namespace leonav;
using namespace leonav::test;

namespace {

const GpsTime kStart = GpsTime::from_week_and_tow(2400, 345'600.0);
constexpr std::int64_t k200Hz = 5'000'000;
constexpr std::int64_t kSecond = kNanosecondsPerSecond;

struct Errors {
  double position = 0.0, velocity = 0.0, attitude = 0.0;
};

Errors compare(const NavState& state, const NavState& truth) {
  return {(state.p_e - truth.p_e).norm(), (state.v_e - truth.v_e).norm(),
          rotation_vector_from_quaternion(truth.q_eb.conjugate() * state.q_eb).norm()};
}

// Largest error at whole minutes.
template <typename Motion>
Errors fly(const char* name, const Motion& motion, std::int64_t duration_ns,
           std::int64_t interval_ns) {
  Mechanization mechanization;
  mechanization.reset(exact_state(motion, kStart, 0));
  Errors worst;
  for (std::int64_t t = 0; t < duration_ns; t += interval_ns) {
    mechanization.advance(exact_sample(motion, kStart, t, interval_ns));
    const std::int64_t end = t + interval_ns;
    if (end % (60 * kSecond) != 0 && end < duration_ns) continue;
    const Errors now = compare(mechanization.state(), exact_state(motion, kStart, end));
    worst.position = std::max(worst.position, now.position);
    worst.velocity = std::max(worst.velocity, now.velocity);
    worst.attitude = std::max(worst.attitude, now.attitude);
  }
  std::cout << "mechanization, " << name << ", " << duration_ns / kSecond << " s: position "
            << worst.position << " m, velocity " << worst.velocity << " m/s, attitude "
            << worst.attitude << " rad\n";
  return worst;
}

const Geodetic kHere{55.0 * kDegree, 8.5 * kDegree, 60.0};

}  // namespace

TEST_CASE("An hour at rest on the rotating Earth", "[ins]") {
  const Static motion(kHere, rotation_from_euler({0.05, -0.1, 2.0}));
  CHECK(fly("static", motion, 3600 * kSecond, k200Hz).position < 0.01);
}

TEST_CASE("An hour on a circle", "[ins]") {
  CHECK(fly("circle 200 m, 20 m/s", Circle(kHere, 200.0, 20.0), 3600 * kSecond, k200Hz).position <
        0.01);
}

TEST_CASE("An hour over the pole", "[ins]") {
  // 3.1e-5 rad/s is 200 m/s; the pole is passed after half an hour.
  const OverThePole motion{static_cast<Real>(std::numbers::pi / 2 - 3.1e-5 * 1800), 3.1e-5L, 0.7L,
                           8000.0L};
  CHECK(fly("over the pole", motion, 3600 * kSecond, k200Hz).position < 0.01);
}

TEST_CASE("Coning and sculling: the two-sample terms do their work", "[ins]") {
  // 2 degrees at 5 Hz, 10 mm: a rough handheld ride. Without the terms the error is tens of times
  // larger, which the second run, fed through fresh states, shows.
  const ConingAndSculling motion(kHere, 2.0 * kDegree, 2.0 * std::numbers::pi * 5.0, 0.01);
  const Errors with = fly("coning 5 Hz", motion, 60 * kSecond, k200Hz);
  Mechanization forgetful;
  forgetful.reset(exact_state(motion, kStart, 0));
  for (std::int64_t t = 0; t < 60 * kSecond; t += k200Hz) {
    forgetful.advance(exact_sample(motion, kStart, t, k200Hz));
    forgetful.reset(forgetful.state());  // forgets the previous sample
  }
  const Errors without = compare(forgetful.state(), exact_state(motion, kStart, 60 * kSecond));
  std::cout << "  without the two-sample terms: position " << without.position << " m, attitude "
            << without.attitude << " rad\n";
  CHECK(with.attitude < 0.1 * without.attitude);
  CHECK(with.position < 0.1 * without.position);
}

TEST_CASE("Error falls with the interval as a third-order method's must", "[ins]") {
  const ConingAndSculling motion(kHere, 2.0 * kDegree, 2.0 * std::numbers::pi * 2.0, 0.05);
  const double coarse = fly("shaken at 100 Hz", motion, 20 * kSecond, 2 * k200Hz).attitude;
  const double fine = fly("shaken at 200 Hz", motion, 20 * kSecond, k200Hz).attitude;
  CHECK(fine < coarse / 8.0);
}

TEST_CASE("Cutting samples anywhere changes next to nothing", "[ins]") {
  const Circle motion(kHere, 50.0, 10.0);
  Mechanization whole, cut;
  whole.reset(exact_state(motion, kStart, 0));
  cut.reset(whole.state());
  std::uint64_t noise = 1;
  for (std::int64_t t = 0; t < 600 * kSecond; t += k200Hz) {
    const ImuSample sample = exact_sample(motion, kStart, t, k200Hz);
    whole.advance(sample);
    noise = noise * 6364136223846793005ULL + 1442695040888963407ULL;
    const std::int64_t at = 1 + static_cast<std::int64_t>(noise >> 33) % (k200Hz - 1);
    if ((noise >> 20) % 40 == 0) {  // five times a second, at any nanosecond
      const ImuSplit parts = split(sample, sample.start().plus_nanoseconds(at));
      cut.advance(parts.before);
      cut.advance(parts.after);
    } else {
      cut.advance(sample);
    }
  }
  const Errors difference = compare(cut.state(), whole.state());
  std::cout << "cut at 5 Hz, 600 s: position " << difference.position << " m, attitude "
            << difference.attitude << " rad\n";
  CHECK(difference.position < 1e-3);
  CHECK(difference.attitude < 1e-8);
  CHECK(cut.state().time == whole.state().time);
}

TEST_CASE("Known errors are removed from every sample", "[ins]") {
  const Circle motion(kHere, 200.0, 20.0);
  ImuErrors errors;
  errors.gyro_bias_b << 1e-3, -2e-3, 3e-3;
  errors.accel_bias_b << 0.1, -0.05, 0.02;
  errors.gyro_scale << 0.01, -0.02, 0.005;
  errors.accel_scale << -0.01, 0.02, 0.012;
  Mechanization mechanization;
  NavState state = exact_state(motion, kStart, 0);
  state.errors = errors;
  mechanization.reset(state);
  for (std::int64_t t = 0; t < 60 * kSecond; t += k200Hz) {
    ImuSample sample = exact_sample(motion, kStart, t, k200Hz);
    const double dt = sample.interval_s();
    // measured = (1 + scale) true + bias
    sample.delta_theta_b +=
        errors.gyro_scale.cwiseProduct(sample.delta_theta_b) + errors.gyro_bias_b * dt;
    sample.delta_velocity_b +=
        errors.accel_scale.cwiseProduct(sample.delta_velocity_b) + errors.accel_bias_b * dt;
    mechanization.advance(sample);
  }
  const Errors difference =
      compare(mechanization.state(), exact_state(motion, kStart, 60 * kSecond));
  CHECK(difference.position < 1e-4);
  CHECK(difference.attitude < 1e-9);
  const Felt expected = felt(motion.at(60.0L - 0.0025L));
  CHECK((mechanization.omega_ib_b() - expected.omega_ib_b.cast<double>()).norm() < 1e-7);
  CHECK((mechanization.specific_force_b() - expected.force_b.cast<double>()).norm() < 1e-6);
}
