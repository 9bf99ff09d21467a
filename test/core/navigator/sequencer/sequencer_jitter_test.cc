// Streams of 500 Hz whose stamps are not where the samples were taken.
#include "core/navigator/sequencer/sequencer.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <random>

#include "support/stages/sequencer_rig.h"

namespace leonav::test {
namespace {

constexpr std::int64_t kInterval = 2 * kMs;
constexpr int kSamples = 30'000;

ImuSample sample_at(GpsTime stamp) { return sample_until(stamp, kInterval); }

struct JitterRun {
  SequencerRig rig;
  std::size_t sent = 0, lost = 0;
  double worst_off_ms = 0.0;

  // Stamps off by a uniform +-jitter of an interval; every `lost_every`th sample is lost.
  JitterRun(double jitter, int lost_every) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> off(-jitter, jitter);
    for (int i = 1; i <= kSamples; ++i) {
      const auto off_ns = static_cast<std::int64_t>(off(generator) * kInterval);
      if (lost_every > 0 && i < kSamples && i % lost_every == 0) {
        ++lost;
      } else {
        send(i, off_ns);
      }
    }
  }
  // Stamped when the host reads them.
  explicit JitterRun(const std::function<std::int64_t(std::int64_t)>& read_time_ns) {
    for (int i = 1; i <= kSamples; ++i) send(i, read_time_ns(i * kInterval) - i * kInterval);
  }

  void send(int i, std::int64_t off_ns) {
    const GpsTime truth = kStart.plus_nanoseconds(i * kInterval);
    rig.sequencer.on_imu(sample_at(truth.plus_nanoseconds(off_ns)));
    ++sent;
    if (i < 1000) return;  // of which the smoothing needs some to settle
    const double late_ms = 1e3 * seconds_between(rig.sequencer.imu_time(), truth);
    worst_off_ms = std::max(worst_off_ms, std::abs(late_ms));
  }
  std::size_t gaps() const { return rig.sequencer.counters().imu_gaps; }
  std::size_t rejected() const { return sent - rig.stages.samples.size(); }
  // Of all gaps, in intervals; checks that there is nothing else between the samples.
  double hole() const {
    std::int64_t sum = 0;
    const auto& samples = rig.stages.samples;
    for (std::size_t i = 1; i < samples.size(); ++i) {
      const std::int64_t gap_ns =
          samples[i].start().nanoseconds() - samples[i - 1].time.nanoseconds();
      REQUIRE(gap_ns >= 0);
      sum += gap_ns;
    }
    return static_cast<double>(sum) / kInterval;
  }
  void check_samples() const {
    for (const ImuSample& sample : rig.stages.samples) {
      REQUIRE(sample.interval_ns >= kInterval / 2);
      REQUIRE(sample.interval_ns <= 2 * kInterval);
      REQUIRE(sample.delta_theta_b == sample_at(kStart).delta_theta_b);
    }
  }
};

void tell(const char* what, const JitterRun& run) {
  std::cout << what << ": " << run.rejected() << " of " << run.sent << " rejected, " << run.gaps()
            << " gaps of " << run.hole() << " intervals, at most " << run.worst_off_ms
            << " ms off\n";
}

TEST_CASE("stamps that jitter cost no increments and open no holes") {
  for (const double jitter : {0.1, 0.3, 0.5}) {
    CAPTURE(jitter);
    const JitterRun run(jitter, 0);
    tell(("stamp jitter " + std::to_string(jitter)).c_str(), run);
    run.check_samples();
    CHECK(run.rejected() == 0);
    CHECK(run.gaps() <= 1);
    CHECK(run.worst_off_ms <= 2.0 * jitter + 1.0);
    CHECK((run.rig.sequencer.counters().imu_smoothed > 0) == (jitter > 0.25));
  }
}

TEST_CASE("stamps that jitter by most of an interval cost few increments") {
  const JitterRun run(0.8, 0);
  tell("stamp jitter 0.8", run);
  run.check_samples();
  CHECK(run.rejected() <= run.sent / 1000);
  CHECK(run.gaps() <= run.sent / 1000);
  CHECK(run.worst_off_ms < 4.0);
}

TEST_CASE("samples read in bursts, as a serial adapter hands them over, are all used") {
  // Read each 16 ms, then one after the other within 0.1 ms.
  const JitterRun run([](std::int64_t ns) {
    const std::int64_t read_ns = (ns + 16 * kMs - 1) / (16 * kMs) * (16 * kMs);
    return read_ns - (read_ns - ns) / 160;
  });
  tell("bursts of 8", run);
  run.check_samples();
  CHECK(run.rejected() == 0);
  CHECK(run.gaps() <= 1);
  CHECK(run.worst_off_ms < 17.0);
}

TEST_CASE("what a host held up is not counted twice: it was bridged as a hole") {
  // Once a second the host does not read for 50 ms, then all that has come in meanwhile.
  const JitterRun run([](std::int64_t ns) {
    const std::int64_t in_second = ns % (1000 * kMs);
    const std::int64_t waits = 500 * kMs - in_second;  // until it reads again
    return waits > 0 && waits < 50 * kMs ? ns + waits - waits / 100 : ns;
  });
  tell("stalls of 50 ms", run);
  run.check_samples();
  CHECK(run.gaps() == 60);
  // Samples used and holes bridged make up the time that passed.
  const double counted = static_cast<double>(run.rig.stages.samples.size()) + run.hole();
  CHECK(counted == Approx(kSamples).margin(60));
  CHECK(run.worst_off_ms < 51.0);
}

TEST_CASE("lost samples remain holes, also where stamps jitter") {
  for (const double jitter : {0.0, 0.1, 0.5, 0.8}) {
    CAPTURE(jitter);
    const JitterRun run(jitter, 100);
    tell(("each 100th lost, stamp jitter " + std::to_string(jitter)).c_str(), run);
    const auto lost = static_cast<double>(run.lost);
    if (jitter <= 0.1) {
      CHECK(run.gaps() == run.lost);
      CHECK(run.hole() == Approx(lost).epsilon(0.01));
    } else {
      CHECK(run.hole() > 0.5 * lost);
      CHECK(run.hole() < 1.2 * lost);
    }
  }
}

TEST_CASE("samples that come far more often than they say are refused, not laid ever further") {
  SequencerRig rig;
  for (int i = 1; i <= kSamples; ++i) {  // each claims five times its interval
    rig.sequencer.on_imu(sample_until(kStart.plus_nanoseconds(i * kInterval), 5 * kInterval));
  }
  const double ahead_s =
      seconds_between(rig.sequencer.imu_time(), kStart.plus_nanoseconds(kSamples * kInterval));
  CHECK(std::abs(ahead_s) < 0.1);
  CHECK(rig.rejected(InputFault::kTimeBackwards) > kSamples / 3);
  CHECK(rig.stages.commands.empty());
}

TEST_CASE("a burst after a hole does not pass for a clock that was set") {
  SequencerRig rig;
  std::int64_t ns = 0;
  for (int i = 0; i < 500; ++i)
    rig.sequencer.on_imu(sample_at(kStart.plus_nanoseconds(ns += kInterval)));
  ns += 200 * kMs;
  for (int i = 0; i < 100; ++i)
    rig.sequencer.on_imu(sample_at(kStart.plus_nanoseconds(ns += 1'000)));
  for (int i = 0; i < 500; ++i)
    rig.sequencer.on_imu(sample_at(kStart.plus_nanoseconds(ns += kInterval)));
  CHECK(rig.stages.commands.empty());
  CHECK(rig.rejected(InputFault::kTimeBackwards) == 99);
  CHECK(rig.sequencer.imu_time() == kStart.plus_nanoseconds(ns));
}

}  // namespace
}  // namespace leonav::test
