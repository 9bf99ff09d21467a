// Receiver clocks that no random walk describes.
#include <cstdio>
#include <random>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

constexpr double kFrom_s = 40.0, kTo_s = 180.0;

SyntheticDriveOptions noisy_options() {
  SyntheticDriveOptions options;
  options.duration_s = kTo_s;
  options.code_sigma_m = 0.3;  // 1 m of the combination
  options.doppler_sigma_m_s = 0.05;
  return options;
}

// Moves the receiver's clock by `clock_m(k)` metres at epoch k: tag and pseudoranges alike.
template <typename ClockM>
SyntheticDrive with_clock(const SyntheticDriveOptions& options, ClockM clock_m) {
  SyntheticDrive drive = synthetic_drive(options);
  for (std::size_t k = 0; k < drive.epochs.size(); ++k) {
    const double shift_m = clock_m(k);
    RawEpoch& raw = drive.epochs[k];
    raw.time = raw.time.plus_seconds(shift_m / kSpeedOfLight);
    for (SignalObservation& o : raw.observations) o.pseudorange_m += shift_m;
  }
  return drive;
}

double worst_without_reset(const SyntheticDrive& drive, const NavigatorConfig& config) {
  const RecordingSink sink = run(drive, config);
  CHECK(resets(sink).empty());
  return worst_error(sink, drive, kFrom_s, kTo_s);
}

}  // namespace

TEST_CASE("a clock that jumps by a millisecond every ten seconds costs no position") {
  const SyntheticDriveOptions options = noisy_options();
  const double ms = 1e-3 * kSpeedOfLight;
  const SyntheticDrive steady = synthetic_drive(options);
  const SyntheticDrive up =
      with_clock(options, [&](std::size_t k) { return ms * static_cast<double>(k / 10); });
  const SyntheticDrive both =
      with_clock(options, [&](std::size_t k) { return k / 10 % 2 == 0 ? -0.5 * ms : 0.5 * ms; });
  for (const MotionModel motion : {MotionModel::kInertial, MotionModel::kConstantVelocity}) {
    const NavigatorConfig config = drive_navigator_config(options, motion);
    const double calm = worst_without_reset(steady, config);
    for (const SyntheticDrive* drive : {&up, &both}) {
      const double worst = worst_without_reset(*drive, config);
      std::printf("millisecond jumps: worst error %.2f m, steady clock %.2f m\n", worst, calm);
      CHECK(worst < calm + 0.5);
    }
  }
}

// A phone sets its clock anew at every epoch. The prediction is judged with the clock taken out, so
// that it costs nothing whether the filter is told or not.
TEST_CASE("a clock of 30 m white noise costs no position, told or not") {
  const SyntheticDriveOptions options = noisy_options();
  std::mt19937_64 generator(5);
  std::normal_distribution<double> normal;
  const SyntheticDrive steady = synthetic_drive(options);
  const SyntheticDrive white =
      with_clock(options, [&](std::size_t) { return 30.0 * normal(generator); });
  for (const MotionModel motion : {MotionModel::kInertial, MotionModel::kConstantVelocity}) {
    NavigatorConfig config = drive_navigator_config(options, motion);
    const double calm = worst_without_reset(steady, config);
    const double untold = worst_without_reset(white, config);
    std::printf("clock of 30 m white noise: worst error %.2f m, steady clock %.2f m\n", untold,
                calm);
    CHECK(untold < calm + 0.1);
    for (const double told_m : {30.0, 42.0, 60.0, 300.0}) {
      config.ekf.clock.offset_noise = told_m;
      const double told = worst_without_reset(white, config);
      const double needless = worst_without_reset(steady, config);
      std::printf("  told %.0f m/sqrt(s): %.2f m, steady clock %.2f m\n", told_m, told, needless);
      CHECK(told < calm + 0.1);
      CHECK(needless < calm + 0.1);
    }
  }
}

}  // namespace leonav::test
