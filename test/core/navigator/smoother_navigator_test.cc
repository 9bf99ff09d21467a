// The smoother in the pipeline: it answers, misses leave the filter's answer, and both replay.
#include <cmath>

#include "support/catch.h"
#include "support/stage_drive.h"

namespace leonav::test {
namespace {

SyntheticDriveOptions noisy_drive(double duration_s) {
  SyntheticDriveOptions options;
  options.duration_s = duration_s;
  options.angle_random_walk = 1e-4;
  options.velocity_random_walk = 1e-3;
  return with_noise(options, 1.0);
}

NavigatorConfig smoother_config(const SyntheticDriveOptions& options) {
  NavigatorConfig config = drive_navigator_config(options);
  config.ekf.use_carrier = true;
  config.estimator = Estimator::kSmoother;
  config.smoother.window = 10;
  return config;
}

double rms_error(const std::vector<Solution>& solutions, const SyntheticDrive& drive,
                 double from_s) {
  double sum = 0.0;
  int count = 0;
  for (const Solution& solution : solutions) {
    if (seconds_between(solution.time, solutions.front().time) < from_s) continue;
    sum += (solution.p_e - drive.truth_at(solution.time).p_e).squaredNorm();
    ++count;
  }
  REQUIRE(count > 0);
  return std::sqrt(sum / count);
}

}  // namespace

TEST_CASE("the smoother answers, no worse than the filter") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive(120.0));
  RecordingSink of_filter, of_smoother;
  NavigatorConfig ekf = smoother_config(drive.options);
  ekf.estimator = Estimator::kEkf;
  Navigator filter(ekf, &of_filter);
  feed(drive, &filter);
  Navigator smoother(smoother_config(drive.options), &of_smoother);
  feed(drive, &smoother);
  REQUIRE(of_smoother.solutions.size() == of_filter.solutions.size());
  CHECK(of_smoother.solutions.back().source == Source::kSmoother);
  CHECK(of_smoother.count(EventKind::kSmootherFailed) == 0);
  CHECK(of_smoother.count(EventKind::kDeadlineMiss) == 0);
  const double filter_m = rms_error(of_filter.solutions, drive, 40.0);
  const double smoother_m = rms_error(of_smoother.solutions, drive, 40.0);
  INFO("filter " << filter_m << " m, smoother " << smoother_m << " m");
  CHECK(smoother_m < 1.03 * filter_m);
}

TEST_CASE("a smoother's recorded misses and iterations are obeyed") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive(60.0));
  const NavigatorConfig config = smoother_config(drive.options);
  std::vector<Decision> recorded;
  for (const std::uint64_t epoch : {25, 26, 40})
    recorded.push_back(decided(epoch, Decision::Subject::kSmoother, false));
  recorded.push_back(decided(45, Decision::Subject::kSmoother, true, 1));
  recorded.push_back(decided(48, Decision::Subject::kKeyframe, false));
  RecordingSink first, second;
  for (RecordingSink* sink : {&first, &second}) {
    Navigator pipeline(config, sink);
    for (const Decision& decision : recorded) pipeline.record(decision);
    feed(drive, &pipeline);
  }
  REQUIRE(first.solutions.size() == second.solutions.size());
  bool same = true;
  for (std::size_t i = 0; i < first.solutions.size(); ++i)
    same = same && first.solutions[i].p_e == second.solutions[i].p_e &&
           first.solutions[i].source == second.solutions[i].source;
  CHECK(same);
  CHECK(first.count(EventKind::kDeadlineMiss) == 3);
  bool one_iteration = false, filter_answered = false;
  for (const SmootherReport& report : first.smoothed) {
    CHECK(report.index != 25);
    CHECK(report.index != 48);
    if (report.index == 45) one_iteration = report.iterations == 1;
  }
  for (const Solution& solution : first.solutions)
    filter_answered =
        filter_answered || (solution.anchor_epoch == 26 && solution.source == Source::kEkf);
  CHECK(one_iteration);
  CHECK(filter_answered);
  CHECK(first.solutions.back().source == Source::kSmoother);
}

TEST_CASE("epochs between two keyframes: the smoother's anchor goes on, with GNSS behind it") {
  SyntheticDriveOptions options = noisy_drive(90.0);
  options.epoch_interval_s = 0.2;
  const SyntheticDrive drive = synthetic_drive(options);
  NavigatorConfig config = smoother_config(options);
  config.realtime.epoch_interval_s = 0.2;
  const RecordingSink sink = run(drive, config);
  CHECK(sink.smoothed.size() < drive.epochs.size() / 4);
  const GpsTime aligned = kSkyEpoch.plus_seconds(50.0);
  std::size_t smoothed = 0, others = 0;
  for (const Solution& solution : sink.solutions)
    if (solution.time > aligned) ++(solution.source == Source::kSmoother ? smoothed : others);
  CHECK(smoothed > 1000);
  CHECK(others == 0);
}

TEST_CASE("without an IMU every epoch has its answer, and says whether GNSS is behind it") {
  SyntheticDriveOptions options = noisy_drive(90.0);
  options.epoch_interval_s = 0.5;
  SyntheticDrive drive = synthetic_drive(options);
  const auto is_out = [](GpsTime time) {
    const double t = seconds_between(time, kSkyEpoch);
    return t > 40.0 && t < 60.0;
  };
  for (RawEpoch& raw : drive.epochs)
    if (is_out(raw.time)) raw.observations.clear();
  NavigatorConfig config = smoother_config(options);
  config.motion = MotionModel::kConstantVelocity;
  config.realtime.epoch_interval_s = 0.5;
  const RecordingSink sink = run(drive, config);
  CHECK(sink.solutions.size() + 2 >= drive.epochs.size());
  std::uint64_t sequence = 0;
  for (const Solution& solution : sink.solutions) {
    CHECK(solution.sequence == ++sequence);
    const double t = seconds_between(solution.time, kSkyEpoch);
    if (t > 43.0 && t < 60.0) CHECK(solution.source == Source::kInsOnly);
    if (t > 20.0 && t < 40.0) CHECK(solution.source != Source::kInsOnly);
  }
  CHECK(sink.solutions.back().source != Source::kInsOnly);
}

}  // namespace leonav::test
