// The smoother in the pipeline: it answers, misses leave the filter's answer, and both replay.
#include <algorithm>
#include <cmath>

#include "support/catch.h"
#include "support/drive/stage_drive.h"

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

TEST_CASE("the oldest keyframe of a full window is given too, better than when it was the newest") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive(120.0));
  RecordingSink sink;
  Navigator navigator(smoother_config(drive.options), &sink);
  feed(drive, &navigator);
  std::vector<Solution> lagged, newest;
  double most_sigmas = 0.0;
  for (const SmootherReport& report : sink.smoothed) {
    if (report.lagged.source == Source::kNone) continue;
    CHECK(report.keyframes == 10);
    CHECK(seconds_between(report.solution.time, report.lagged.time) == Approx(9.0));
    CHECK(std::isnan(report.lagged.horizontal_protection_m));
    lagged.push_back(report.lagged);
    newest.push_back(report.solution);
    const double error_m = (report.lagged.p_e - drive.truth_at(report.lagged.time).p_e).norm();
    most_sigmas = std::max(most_sigmas, error_m / report.lagged.sigma_p_n.norm());
  }
  REQUIRE(lagged.size() > 40);
  const double lagged_m = rms_error(lagged, drive, 0.0), newest_m = rms_error(newest, drive, 0.0);
  INFO("oldest " << lagged_m << " m, newest " << newest_m << " m");
  CHECK(lagged_m < 1.01 * newest_m);
  CHECK(most_sigmas < 3.5);

  NavigatorConfig without = smoother_config(drive.options);
  without.smoother.fixed_lag = false;
  RecordingSink none;
  Navigator other(without, &none);
  feed(drive, &other);
  for (const SmootherReport& report : none.smoothed) CHECK(report.lagged.source == Source::kNone);
}

TEST_CASE("Ceres answers as the chain does") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive(60.0));
  RecordingSink of_chain, of_ceres;
  NavigatorConfig config = smoother_config(drive.options);
  Navigator chain(config, &of_chain);
  feed(drive, &chain);
  config.smoother.solver = SmootherSolver::kCeres;
  config.smoother.ceres_loss = GENERATE(CeresLoss::kIgg3, CeresLoss::kHuber, CeresLoss::kCauchy);
  Navigator ceres(config, &of_ceres);
  feed(drive, &ceres);
  REQUIRE(of_ceres.smoothed.size() == of_chain.smoothed.size());
  CHECK(of_ceres.count(EventKind::kSmootherFailed) == 0);
  const Solution& a = of_ceres.smoothed.back().solution;
  const Solution& b = of_chain.smoothed.back().solution;
  CHECK(a.source == Source::kSmoother);
  CHECK((a.p_e - b.p_e).norm() < 0.3 * b.sigma_p_n.norm());
}

TEST_CASE("a heading from outside replaces the window's as well") {
  SyntheticDriveOptions options = noisy_drive(60.0);
  options.standstill_s = 1000.0;
  const SyntheticDrive drive = synthetic_drive(options);
  RecordingSink sink;
  Navigator navigator(smoother_config(options), &sink);
  const double truth_yaw = std::atan2(100.0, 100.0);
  int seen = 0;
  feed(drive, &navigator, [&](const RawEpoch&, Sequencer* sequencer) {
    ++seen;
    if (seen == 10) sequencer->on_command({CommandKind::kSetHeading, truth_yaw + 0.5, 0.05});
    if (seen == 30) sequencer->on_command({CommandKind::kSetHeading, truth_yaw, 0.02});
  });
  const Solution& last = sink.smoothed.back().solution;
  REQUIRE(last.source == Source::kSmoother);
  CHECK(last.yaw == Approx(truth_yaw).margin(3.0 * last.sigma_rpy.z()));
  CHECK(last.sigma_rpy.z() < 0.03);
}

TEST_CASE("a filter restarted in mid-drive leaves the smoother its attitude and its position") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive(120.0));
  RecordingSink sink;
  Navigator navigator(smoother_config(drive.options), &sink);
  int seen = 0;
  GpsTime restart;
  feed(drive, &navigator, [&](const RawEpoch& epoch, Sequencer* sequencer) {
    if (++seen != 70) return;
    restart = epoch.time;
    sequencer->on_command({CommandKind::kRestart});
  });
  // The filter stays on its own for ten seconds and then takes over the window's state.
  REQUIRE(test::resets(sink) == std::vector<ResetCause>{ResetCause::kCommand, ResetCause::kWindow});
  double before_m = 0.0, after_m = 0.0;
  int without_attitude = 0;
  for (const Solution& solution : sink.solutions) {
    const double since_s = seconds_between(solution.time, restart);
    if (since_s < -30.0) continue;
    double& most_m = since_s < 0.0 ? before_m : after_m;
    if (since_s > 0.0 && solution.source != Source::kSmoother) {
      ++without_attitude;
      continue;
    }
    most_m = std::max(most_m, (solution.p_e - drive.truth_at(solution.time).p_e).norm());
  }
  INFO("largest error before " << before_m << " m, after " << after_m << " m; without the smoother "
                               << without_attitude << " of " << sink.solutions.size());
  double filter_before_m = 0.0, filter_after_m = 0.0;
  for (const EpochReport& report : sink.epochs) {
    const double since_s = seconds_between(report.time, restart);
    if (since_s < -30.0 || (since_s >= 0.0 && since_s < 12.0)) continue;
    REQUIRE(report.solution.source == Source::kEkf);
    double& most_m = since_s < 0.0 ? filter_before_m : filter_after_m;
    most_m = std::max(most_m, (report.solution.p_e - drive.truth_at(report.time).p_e).norm());
  }
  INFO("filter " << filter_before_m << " m before, " << filter_after_m << " m from 12 s on after");
  CHECK(filter_after_m < 2.0 * filter_before_m);
  CHECK(without_attitude < 600);  // three seconds: two epochs, and the deadline
  CHECK(after_m < 2.0 * before_m);
  CHECK(sink.count(EventKind::kSmootherFailed) == 0);
}

TEST_CASE("a heading given between a restart and the alignment ends the window") {
  SyntheticDriveOptions options = noisy_drive(80.0);
  options.standstill_s = 1000.0;
  const SyntheticDrive drive = synthetic_drive(options);
  RecordingSink sink;
  Navigator navigator(smoother_config(options), &sink);
  const double truth_yaw = std::atan2(100.0, 100.0);
  int seen = 0;
  feed(drive, &navigator, [&](const RawEpoch&, Sequencer* sequencer) {
    ++seen;
    if (seen == 10) sequencer->on_command({CommandKind::kSetHeading, truth_yaw + 0.5, 0.05});
    if (seen == 40) sequencer->on_command({CommandKind::kRestart});
    if (seen == 42) sequencer->on_command({CommandKind::kSetHeading, truth_yaw, 0.3});
  });
  const Solution& last = sink.solutions.back();
  CHECK(last.sigma_rpy.z() < 0.31);
  CHECK(last.yaw == Approx(truth_yaw).margin(3.0 * last.sigma_rpy.z()));
  CHECK(last.yaw < truth_yaw + 0.25);  // nearer to the second heading than to the first one
}

TEST_CASE("a heading given right before the filter would follow the window is kept") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive(100.0));
  // Replays a restart and, behind the keyframe after which the filter would follow, a heading.
  const auto run = [&](GpsTime follows, RecordingSink* sink) {
    Navigator navigator(smoother_config(drive.options), sink);
    int seen = 0;
    feed(drive, &navigator, [&](const RawEpoch& epoch, Sequencer* sequencer) {
      if (++seen == 70) sequencer->on_command({CommandKind::kRestart});
      if (!follows.is_set() || std::abs(seconds_between(epoch.time, follows) - 1.0) > 1e-6) return;
      sequencer->on_command({CommandKind::kSetHeading, sink->epochs.back().solution.yaw, 0.02});
    });
  };
  RecordingSink alone, with_heading;
  run(GpsTime(), &alone);
  const auto followed =
      std::find_if(alone.events.begin(), alone.events.end(), [](const Event& event) {
        return event.kind == EventKind::kFilterReset &&
               event.code == static_cast<std::uint8_t>(ResetCause::kWindow);
      });
  REQUIRE(followed != alone.events.end());
  run(followed->time, &with_heading);
  CHECK(resets(with_heading) == std::vector<ResetCause>{ResetCause::kCommand});
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

TEST_CASE("where a solve fails the filter answers, with its event, and the smoother comes back") {
  const SyntheticDrive drive = synthetic_drive(noisy_drive(90.0));
  NavigatorConfig config = smoother_config(drive.options);
  RecordingSink of_filter, well, drilled;
  const auto run_into = [&](RecordingSink* sink) {
    Navigator navigator(config, sink);
    feed(drive, &navigator);
  };
  run_into(&well);
  config.smoother.drill_failure_every = GENERATE(20, 1);
  config.smoother.drill_failure = GENERATE(DrilledFailure::kSingular, DrilledFailure::kDiverged);
  if (config.smoother.drill_failure_every > 1)
    config.smoother.solver = GENERATE(SmootherSolver::kChain, SmootherSolver::kCeres);
  run_into(&drilled);
  config.estimator = Estimator::kEkf;
  run_into(&of_filter);
  const bool singular = config.smoother.drill_failure == DrilledFailure::kSingular;
  const auto every = static_cast<std::uint64_t>(config.smoother.drill_failure_every);
  REQUIRE(drilled.solutions.size() == well.solutions.size());
  std::uint64_t failures = 0;
  for (const SmootherReport& report : drilled.smoothed) {
    if (report.index % every != 0) continue;
    ++failures;
    CHECK(report.status == (singular ? SmootherStatus::kSingular : SmootherStatus::kDiverged));
    CHECK(report.solution.source == Source::kNone);
  }
  CHECK(failures >= (every == 1 ? 50 : 3));
  CHECK(drilled.count(EventKind::kSmootherFailed) > 0);  // thinned
  int by_filter = 0, by_smoother = 0;
  for (const Solution& solution : drilled.solutions) {
    if (solution.anchor_epoch % every == 0) CHECK(solution.source != Source::kSmoother);
    by_filter += solution.source == Source::kEkf ? 1 : 0;
    by_smoother += solution.source == Source::kSmoother ? 1 : 0;
  }
  CHECK(by_filter > 200);
  if (every == 1)
    CHECK(by_smoother == 0);
  else
    CHECK(drilled.solutions.back().source == Source::kSmoother);
  CHECK(rms_error(drilled.solutions, drive, 40.0) <
        1.03 * rms_error(of_filter.solutions, drive, 40.0));
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
