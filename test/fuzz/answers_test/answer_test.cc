// What the targets prove of the Sequencer, with the whole navigator behind it: after any script of
// inputs a drive brings an answer within ten seconds.
#include <cstdio>
#include <memory>

#include "core/navigator/navigator.h"
#include "mutator.h"
#include "support/catch.h"
#include "support/drive/synthetic_drive.h"
#include "test/fuzz/sequencer_script.h"

namespace leonav::test {
namespace {

constexpr double kMostError_m = 20.0;  // of a position by codes, which starts anew
constexpr double kMostWait_s = 10.0;

struct Newest final : OutputSink {
  void on_solution(const Solution& one) override { solution = one; }
  void on_epoch(const EpochReport&) override {}
  void on_event(const Event&) override {}
  void on_decision(const Decision&) override {}
  void on_smoother(const SmootherReport&) override {}
  Solution solution;
};

// The drive's vehicle; the rest as the script has it.
NavigatorConfig config_for(const SequencerScript& script, const SyntheticDriveOptions& options) {
  NavigatorConfig config = script.config;
  config.motion = MotionModel::kInertial;
  config.vehicle.lever_arm_b = options.lever_arm_b;
  config.vehicle.mounting_rpy.setZero();
  config.imu_time_offset_s = 0.0;
  config.realtime.epoch_interval_s = options.epoch_interval_s;
  return config;
}

// Returns how long after the drive's begin the first solution came that is one of now, and throws
// where a solution is too far from the truth.
double time_to_answer_s(const SequencerScript& script, const SyntheticDrive& drive) {
  Newest sink;
  const auto navigator =
      std::make_unique<Navigator>(config_for(script, drive.options), &sink);  // large
  Sequencer& sequencer = navigator->sequencer();
  play(script, &sequencer);
  double answer_s = kMostWait_s + 1.0;
  feed(
      drive, 0.06, [&](const Ephemeris& one) { sequencer.on_ephemeris(one); },
      [&](const ImuSample& sample) {
        sequencer.on_imu(sample);
        const Solution& now = sink.solution;
        if (now.source == Source::kNone || now.time != sample.time) return;
        answer_s = std::min(answer_s, seconds_between(sample.time, kSkyEpoch));
        const double error_m = (now.p_e - drive.truth_at(now.time).p_e).norm();
        if (error_m > kMostError_m)
          throw Finding("a solution is " + std::to_string(error_m) + " m off\n" + text_of(script));
      },
      [&](const RawEpoch& raw) { sequencer.on_raw_epoch(raw); });
  return answer_s;
}

TEST_CASE("after any script a drive brings an answer within ten seconds") {
  SyntheticDriveOptions options;
  options.duration_s = kMostWait_s + 2.0;
  const SyntheticDrive drive = synthetic_drive(with_noise(options, 0.5));
  const auto seeds = corpus_of("sequencer");
  REQUIRE(!seeds.empty());
  Mutator mutator(&seeds);
  double longest_s = 0.0;
  constexpr int kScripts = 60;
  for (int k = 0; k < kScripts; ++k) {
    const SequencerScript script = script_from(mutator.next());
    const double s = time_to_answer_s(script, drive);
    INFO(text_of(script));
    CHECK(s <= kMostWait_s);
    longest_s = std::max(longest_s, s);
  }
  std::printf("%d scripts: an answer after at most %.2f s of a drive\n", kScripts, longest_s);
}

}  // namespace
}  // namespace leonav::test
