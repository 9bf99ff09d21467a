// A sensor that repeats its values against good ones that do so at rest.
#include "core/navigator/sequencer/internal/frozen_imu_monitor.h"

#include <cmath>
#include <functional>
#include <random>

#include "support/catch.h"
#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

using Eigen::Vector3d;

// A sensor whose rates are a function of time, at 200 Hz.
class Sensor {
 public:
  std::int64_t interval_ns = 5 * kMs;

  ImuSample measure(const Vector3d& rate, const Vector3d& force) {
    ImuSample sample;
    sample.time = time_ = time_.plus_nanoseconds(interval_ns);
    sample.interval_ns = interval_ns;
    sample.delta_theta_b = sample.interval_s() * rate;
    sample.delta_velocity_b = sample.interval_s() * force;
    return sample;
  }
  Vector3d noise(double sigma) {
    std::normal_distribution<double> normal(0.0, sigma);
    return {normal(dice_), normal(dice_), normal(dice_)};
  }
  ImuSample noisy(double gyro_sigma = 1e-3, double accel_sigma = 5e-3) {
    return measure(kRate + noise(gyro_sigma), kForce + noise(accel_sigma));
  }

  const Vector3d kRate{0.01, -0.02, 0.2}, kForce{0.3, 0.1, -9.8};

 private:
  GpsTime time_ = kStart;
  std::mt19937_64 dice_{1};
};

// Feeds `seconds` and returns how many samples are called frozen.
int count_frozen(FrozenImuMonitor* monitor, double seconds,
                 const std::function<ImuSample(int)>& sample) {
  int count = 0;
  for (int k = 0; k < static_cast<int>(seconds * 200.0); ++k) count += monitor->add(sample(k));
  return count;
}

Vector3d rounded(const Vector3d& value, double digit) {
  return digit * (value / digit).array().round().matrix();
}

TEST_CASE("values that stop changing are found within a quarter of a second, again and again") {
  Sensor sensor;
  FrozenImuMonitor monitor;
  for (int k = 0; k < 3; ++k) {
    CHECK(count_frozen(&monitor, 10.0, [&](int) { return sensor.noisy(); }) == 0);
    const int frozen = count_frozen(
        &monitor, 10.0, [&](int) { return sensor.measure(sensor.kRate, sensor.kForce); });
    CHECK(frozen == 2000 - static_cast<int>(FrozenImuMonitor::kMinRun));
  }
  CHECK_FALSE(monitor.add(sensor.noisy()));
}

TEST_CASE("a frozen rate is found where the intervals jitter") {
  Sensor sensor;
  FrozenImuMonitor monitor;
  count_frozen(&monitor, 10.0, [&](int) { return sensor.noisy(); });
  const int frozen = count_frozen(&monitor, 1.0, [&](int k) {
    sensor.interval_ns = 5 * kMs + 12'345 * (k % 7);
    return sensor.measure(sensor.kRate, sensor.kForce);
  });
  CHECK(frozen > 140);
}

TEST_CASE("a sensor with coarse digits may stand still after a drive") {
  for (const double digit : {0.01, 0.02, 0.1}) {  // m/s^2
    CAPTURE(digit);
    Sensor sensor;
    FrozenImuMonitor monitor;
    const auto read = [&](const Vector3d& rate, const Vector3d& force) {
      return sensor.measure(rounded(rate, digit), rounded(force, digit));
    };
    const int frozen = count_frozen(&monitor, 120.0, [&](int k) {
      const bool stands = k >= 10'000;
      return read(sensor.kRate + sensor.noise(stands ? 1e-4 : 0.1),
                  sensor.kForce + sensor.noise(stands ? 1e-4 : 1.0));
    });
    CHECK(frozen == 0);
  }
}

TEST_CASE("a sensor without noise may stand still after a drive") {
  Sensor sensor;
  FrozenImuMonitor monitor;
  // From positions of an Earth's radius a simulator has rounding of 4e-5 m/s^2.
  for (const double rounding : {0.0, 4e-5}) {
    const int frozen = count_frozen(&monitor, 60.0, [&](int k) {
      if (k >= 10'000) return sensor.measure({0, 0, 5e-5}, {0, 0, -9.8});
      const double t = k * 0.005;
      const Vector3d wave(std::sin(2.0 * t), std::cos(3.0 * t), std::sin(t));
      return sensor.measure(0.1 * wave, sensor.kForce + 2.0 * wave + sensor.noise(rounding));
    });
    CHECK(frozen == 0);
  }
}

TEST_CASE("a sensor that is read more often than it measures is not frozen") {
  for (const int repeats : {2, 20, 100, 400}) {
    CAPTURE(repeats);
    Sensor sensor;
    FrozenImuMonitor monitor;
    Vector3d rate = Vector3d::Zero(), force = Vector3d::Zero();
    const int frozen = count_frozen(&monitor, 20.0 * repeats, [&](int k) {
      if (k % repeats == 0) {
        rate = sensor.kRate + sensor.noise(1e-3);
        force = sensor.kForce + sensor.noise(5e-3);
      }
      return sensor.measure(rate, force);
    });
    CHECK(frozen == 0);
  }
}

TEST_CASE("a message that comes again and again is no frozen sensor") {
  Sensor sensor;
  FrozenImuMonitor monitor;
  count_frozen(&monitor, 10.0, [&](int) { return sensor.noisy(); });
  const ImuSample last = sensor.noisy();
  CHECK(count_frozen(&monitor, 10.0, [&](int) { return last; }) == 0);
}

TEST_CASE("a frozen IMU is a gap: its epochs are issued, and navigation goes on behind it") {
  SequencerRig rig;
  Sensor sensor;
  std::int64_t now_ms = 0;
  const auto drive = [&](int seconds, bool frozen) {
    for (int k = 0; k < seconds; ++k, now_ms += 1000) {
      for (int i = 0; i < 200; ++i)
        rig.sequencer.on_imu(frozen ? sensor.measure(sensor.kRate, sensor.kForce) : sensor.noisy());
      rig.sequencer.on_raw_epoch(epoch_at(at_ms(now_ms + 1000)));
    }
  };
  drive(20, false);
  CHECK(rig.rejected() == 0);
  drive(5, true);
  CHECK(rig.rejected(InputFault::kNotSane) == 1000 - FrozenImuMonitor::kMinRun);
  drive(5, false);
  CHECK(rig.rejected() == 1000 - FrozenImuMonitor::kMinRun);
  CHECK(rig.sequencer.counters().imu_gaps == 1);
  CHECK(rig.sequencer.counters().epochs == 30);
  CHECK(rig.stages.commands.empty());
}

}  // namespace
}  // namespace leonav::test
