// FrozenImuMonitor finds an IMU that repeats its values instead of measuring.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/base/gps_time.h"
#include "core/inertial/strapdown/imu.h"

namespace leonav {

// A sensor that measures has noise: of one whose noise has been seen, all six rates are never the
// same for a quarter of a second and fifty samples. It is taken for frozen then. The rule must not
// fire on a good sensor at rest, of which four kinds repeat their values:
// - one that is read more often than it measures: the run must be eight times the longest before;
// - one with coarse digits: most of its steps must not be large against the noise that every
//   accelerometer has, so steps of at most kFineStep must have been seen;
// - a simulated one without noise: its values are smooth, hence the noise must be seen as steps of
//   at least kNoise that turn back, in an eighth of the samples;
// - one whose messages are repeated: the stamps must have advanced.
// What has been seen is kept for good, because it belongs to the sensor.
class FrozenImuMonitor {
 public:
  static constexpr std::uint64_t kMinRun = 50;  // equal samples
  static constexpr std::int64_t kMinRunNs = 250'000'000;
  static constexpr std::uint64_t kTimesLongest = 8;
  static constexpr std::uint64_t kMinSamples = 1000;  // that have changed
  static constexpr std::uint64_t kMinFineSteps = 100;
  static constexpr std::uint64_t kSamplesPerReversal = 8;
  // Steps of the specific force from one sample to the next, m/s^2. White noise of 20 ug/sqrt(Hz),
  // which is that of a good sensor, is 2e-3 at 200 Hz; an accelerometer of 16 bits and 16 g has
  // steps of 5e-3 and noise of more than 7e-3. Below kDigit is rounding.
  static constexpr double kFineStep = 5e-3, kNoise = 1e-4, kDigit = 1e-6;

  // Adds a sample that is without another fault. Returns whether the sensor is frozen.
  bool add(const ImuSample& sample);

 private:
  using Rates = Eigen::Matrix<double, 6, 1>;  // rad/s, m/s^2

  void learn(const Eigen::Vector3d& step);
  bool has_shown_noise() const;

  Rates rates_ = Rates::Zero();                     // of the last sample
  Eigen::Vector3d step_ = Eigen::Vector3d::Zero();  // of the specific force, the last one
  GpsTime begin_;                                   // of the run of equal samples; unset: none
  std::uint64_t run_ = 0, longest_run_ = 0;         // of samples; the longest that has ended
  std::uint64_t samples_ = 0, fine_steps_ = 0, reversals_ = 0;
  bool frozen_ = false;
};

}  // namespace leonav
