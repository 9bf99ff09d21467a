// A drive on which no IMU sample comes for a while: the answer goes on from GNSS alone.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

namespace leonav::test {
namespace {

SyntheticDriveOptions noisy_drive() {
  SyntheticDriveOptions options;
  options.duration_s = 140.0;
  options.angle_random_walk = 1e-4;
  options.velocity_random_walk = 1e-3;
  return with_noise(options, 0.5);
}

// Without the samples in (from_s, to_s], and later ones `late_s` after their time.
void feed_but(double from_s, double to_s, const SyntheticDrive& drive, Navigator* navigator,
              double late_s = 0.0) {
  Sequencer& sequencer = navigator->sequencer();
  for (const Ephemeris& ephemeris : drive.ephemerides) sequencer.on_ephemeris(ephemeris);
  std::size_t next = 0;
  for (const RawEpoch& raw : drive.epochs) {
    for (; next < drive.imu.size(); ++next) {
      const double t = seconds(drive.imu[next].time);
      if (t + (t > to_s ? late_s : 0.0) >= seconds(raw.time) + 0.06) break;
      if (t <= from_s || t > to_s) sequencer.on_imu(drive.imu[next]);
    }
    sequencer.on_raw_epoch(raw);
  }
}

// What a silence from `from_s` to `to_s` costs.
struct Silence {
  int answers = 0;                                                  // within it
  double worst_m = 0.0, worst_sigmas = 0.0, largest_sigma_m = 0.0;  // of these, 3D
  double longest_gap_s = 0.0;                                       // of the whole drive
  double worst_after_m = 0.0;                                       // from 15 s after it
};

Silence judge(const RecordingSink& sink, const SyntheticDrive& drive, double from_s, double to_s) {
  Silence silence;
  for (std::size_t i = 1; i < sink.solutions.size(); ++i) {
    const Solution& solution = sink.solutions[i];
    const double gap_s = seconds_between(solution.time, sink.solutions[i - 1].time);
    REQUIRE(gap_s > 0.0);
    silence.longest_gap_s = std::max(silence.longest_gap_s, gap_s);
    const double t = seconds(solution.time);
    const double error_m = (solution.p_e - drive.truth_at(solution.time).p_e).norm();
    const double sigma_m = solution.sigma_p_n.norm();
    if (t > to_s + 15.0) silence.worst_after_m = std::max(silence.worst_after_m, error_m);
    if (t <= from_s || t > to_s) continue;
    ++silence.answers;
    silence.worst_m = std::max(silence.worst_m, error_m);
    silence.worst_sigmas = std::max(silence.worst_sigmas, error_m / sigma_m);
    silence.largest_sigma_m = std::max(silence.largest_sigma_m, sigma_m);
  }
  return silence;
}

}  // namespace

TEST_CASE("while the IMU is silent each epoch gives an answer, and then the IMU goes on") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive());
  const bool smoother = GENERATE(false, true);
  const double length_s = GENERATE(2.0, 4.0, 8.0, 50.0);
  NavigatorConfig config = drive_navigator_config(drive.options);
  config.ekf.use_carrier = true;
  if (smoother) config.estimator = Estimator::kSmoother;
  RecordingSink sink;
  Navigator navigator(config, &sink);
  feed_but(60.5, 60.5 + length_s, drive, &navigator);
  const Silence silence = judge(sink, drive, 60.5, 60.5 + length_s);
  std::printf(
      "%s, %.0f s without IMU: %d answers, worst %.2f m (%.1f sigmas, largest sigma %.2f m), "
      "longest gap %.2f s, "
      "after it %.2f m\n",
      smoother ? "smoother" : "filter", length_s, silence.answers, silence.worst_m,
      silence.worst_sigmas, silence.largest_sigma_m, silence.longest_gap_s, silence.worst_after_m);
  CHECK(silence.answers >= static_cast<int>(length_s) - 6);
  CHECK(silence.longest_gap_s < 5.6);
  CHECK(silence.worst_sigmas < 3.0);
  CHECK(silence.largest_sigma_m < 5.0);
  CHECK(silence.worst_after_m < 1.0);
  CHECK(sink.count(EventKind::kDeadlineMiss) == 0);
}

TEST_CASE("samples that come back late are used as far as epochs wait for them") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive());
  const double late_s = GENERATE(0.5, 1.5, 2.5, 5.0, 9.0);
  CAPTURE(late_s);
  RecordingSink sink;
  Navigator navigator(drive_navigator_config(drive.options), &sink);
  feed_but(60.5, 80.5, drive, &navigator, late_s);
  const Silence silence = judge(sink, drive, 60.5, 80.5);
  std::printf(
      "samples %.1f s late: %zu solutions, worst in the silence %.2f m (%.1f sigmas), after it "
      "%.2f m\n",
      late_s, sink.solutions.size(), silence.worst_m, silence.worst_sigmas, silence.worst_after_m);
  CHECK(silence.answers >= 14);
  CHECK(silence.worst_sigmas < 3.0);
  CHECK(silence.worst_after_m < 3.0);
  // Five seconds and more are too much: GNSS alone answers, once an epoch.
  const bool used = late_s < 3.0;
  CHECK(sink.solutions.back().source == (used ? Source::kEkf : Source::kAligning));
  CHECK(seconds(sink.solutions.back().time) > 140.0 - (used ? late_s : 0.0) - 3.0);
  const auto since_silence =
      std::count_if(sink.solutions.begin(), sink.solutions.end(),
                    [](const Solution& solution) { return seconds(solution.time) > 85.0; });
  if (used)
    CHECK(since_silence > 200 * 45);
  else
    CHECK(since_silence <= 60);
}

TEST_CASE("GNSS that begins before the IMU is answered as aligning") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive());
  RecordingSink sink;
  Navigator navigator(drive_navigator_config(drive.options), &sink);
  feed_but(-1.0, 30.0, drive, &navigator);
  REQUIRE_FALSE(sink.solutions.empty());
  CHECK(seconds(sink.solutions.front().time) < 8.0);
  CHECK(sink.solutions.front().source == Source::kAligning);
  CHECK(sink.solutions.back().source == Source::kEkf);
  CHECK(sink.solutions.back().has_attitude);
}

}  // namespace leonav::test
