// Stamps by pulses of a sensor at a receiver, with made clocks: drift, resolution, queues, pulses
// that are lost, steps.
#include <cmath>
#include <limits>
#include <random>

#include "stamp_times.h"
#include "support/catch.h"
#include "tools/connect/stamps/imu_stamper.h"

namespace leonav {
namespace {

using test::gps_at;
using test::kMillisecond_ns;
using test::kSecond_ns;
using test::kStart;

// A sensor that takes a sample each `spacing_ns`, and a receiver that sees a pulse at each n-th.
struct PulseRig {
  explicit PulseRig(double drift_ppm, double latency_s = 0.004)
      : drift(drift_ppm * 1e-6), stamper(&clock, {latency_s, 0.0}, &pulses) {}

  double drift;
  std::int64_t spacing_ns = 5 * kMillisecond_ns;
  int every = 200;            // pulses of 1 Hz
  bool marks_pulses = false;  // the sensor marks samples with pulses
  bool has_pulses = true;
  std::int64_t offset_ns = 77 * kSecond_ns;  // of the sensor's clock
  GpsClock clock{TimeReference::kGnss, 0.05};
  PulseQueue pulses;
  ImuStamper stamper;
  std::mt19937 dice{1};
  std::int64_t now_ns = 0;  // of the host
  std::int64_t samples = 0;
  double worst_ms = 0.0, mean_ms = 0.0;  // of the last run
  std::deque<PulseMark> on_the_way;

  // Feeds `seconds`; the errors are those of its samples from `skip_s` on.
  void run(double seconds, double skip_s = 0.0) {
    std::exponential_distribution<double> queue_ms(1.0 / 0.8);
    std::normal_distribution<double> noise_ns(0.0, 30.0);
    const std::int64_t begin_ns = now_ns;
    double sum_ms = 0.0;
    long count = 0;
    worst_ms = 0.0;
    for (; now_ns < begin_ns + static_cast<std::int64_t>(seconds * 1e9); now_ns += spacing_ns) {
      if (now_ns % kSecond_ns == 0) {
        clock.on_epoch(gps_at(now_ns), now_ns + 50 * kMillisecond_ns +
                                           std::llround(queue_ms(dice) * kMillisecond_ns));
      }
      const bool has_pulse = samples++ % every == 0;
      if (has_pulse && has_pulses) {
        on_the_way.push_back(
            {gps_at(now_ns).plus_nanoseconds(std::llround(noise_ns(dice))), 30e-9});
      }
      // The receiver tells of a pulse a tenth of a second later.
      while (!on_the_way.empty() &&
             nanoseconds_between(gps_at(now_ns), on_the_way.front().time) > 100 * kMillisecond_ns) {
        pulses.push(on_the_way.front());
        on_the_way.pop_front();
      }
      ImuReading reading;
      reading.arrival_ns =
          now_ns + 4 * kMillisecond_ns + std::llround(queue_ms(dice) * kMillisecond_ns);
      const auto clock_ns = offset_ns + now_ns + std::llround(static_cast<double>(now_ns) * drift);
      reading.clock_ns = clock_ns / 100'000 * 100'000;  // the clock shows 0.1 ms
      reading.clock_step_s = 1e-4;
      if (marks_pulses) reading.has_pulse = has_pulse;
      const std::optional<GpsTime> stamp = stamper.stamp(reading);
      if (!stamp || static_cast<double>(now_ns - begin_ns) < skip_s * 1e9) continue;
      const double error_ms =
          static_cast<double>(nanoseconds_between(*stamp, gps_at(now_ns))) * 1e-6;
      worst_ms = std::max(worst_ms, std::abs(error_ms));
      sum_ms += error_ms;
      ++count;
    }
    mean_ms = count > 0 ? sum_ms / static_cast<double>(count) : NAN;
  }
  bool is_by_pulses() const { return stamper.kind() == ImuStamper::Kind::kPulse; }
};

}  // namespace

TEST_CASE("Pulses tie a drifting clock to GPS time within its resolution", "[connect]") {
  for (const double drift_ppm : {-100.0, 0.0, 100.0}) {
    // At each sample, and once a second.
    for (const int every : {1, 200}) {
      PulseRig rig(drift_ppm);
      rig.every = every;
      rig.run(20.0);
      REQUIRE(rig.is_by_pulses());
      rig.run(60.0);
      CAPTURE(drift_ppm, every, rig.mean_ms, rig.stamper.text());
      CHECK(rig.worst_ms < 0.16);  // the resolution is 0.1 ms
      CHECK(std::abs(rig.mean_ms) < 0.06);
      CHECK(rig.stamper.sigma_s() < 0.06e-3);
      CHECK(rig.stamper.sigma_s() > 0.028e-3);  // the resolution's own is 0.029 ms
      CHECK(rig.stamper.steps() == 0);
      CHECK_THAT(rig.stamper.text(), Catch::Contains("pulses at the receiver"));
    }
  }
}

TEST_CASE("A wrong latency does not matter where pulses are used", "[connect]") {
  PulseRig rig(100.0, 0.003);  // it is 4 ms
  rig.run(6.5);
  REQUIRE_FALSE(rig.is_by_pulses());
  rig.run(0.5);
  CHECK(rig.worst_ms > 0.9);
  rig.run(30.0, 5.0);
  CHECK(rig.is_by_pulses());
  CHECK(rig.worst_ms < 0.16);
  CHECK_THAT(rig.stamper.text(), Catch::Contains("of +-2.50 ms that are allowed"));
}

TEST_CASE("Lost pulses cost nothing for a minute, then arrivals serve again", "[connect]") {
  PulseRig rig(100.0);
  rig.run(40.0);
  REQUIRE(rig.is_by_pulses());
  rig.has_pulses = false;
  rig.run(55.0);
  CHECK(rig.is_by_pulses());
  CHECK(rig.worst_ms < 0.25);
  rig.run(10.0);
  CHECK(rig.stamper.kind() == ImuStamper::Kind::kLine);
  CHECK_THAT(rig.stamper.text(), Catch::Contains("no pulses that can be used"));
  rig.has_pulses = true;
  rig.run(10.0);
  CHECK(rig.is_by_pulses());
  rig.run(10.0);
  CHECK(rig.worst_ms < 0.25);
  CHECK(rig.stamper.steps() == 0);
}

TEST_CASE("A step of the clock is followed and told", "[connect]") {
  SECTION("that arrivals do not show") {
    PulseRig rig(100.0);
    rig.run(30.0);
    rig.offset_ns += 1'400'000;
    rig.run(30.0, 8.0);
    CHECK(rig.worst_ms < 0.25);
    CHECK(rig.stamper.steps() == 1);
    CHECK_THAT(rig.stamper.text(), Catch::Contains("1 steps, the last by -0.0014 s"));
  }
  SECTION("by more than the time between samples") {
    for (const std::int64_t step_ns : {13 * kMillisecond_ns, 3 * kSecond_ns, -40 * kSecond_ns}) {
      PulseRig rig(100.0);
      rig.run(30.0);
      rig.offset_ns += step_ns;
      rig.run(60.0, 25.0);
      CAPTURE(step_ns, rig.stamper.text());
      CHECK(rig.is_by_pulses());
      CHECK(rig.worst_ms < 0.25);
      CHECK(rig.stamper.steps() >= 1);
      CHECK_THAT(rig.stamper.text(), Catch::Contains("begun anew"));
    }
  }
}

TEST_CASE("Which sample a pulse belongs to is known as far as arrivals are right", "[connect]") {
  // Arrivals are wrong by 4 ms, of 2.5 ms that are allowed: the next sample is taken.
  PulseRig rig(0.0, 0.0);
  rig.run(40.0, 30.0);
  CHECK(rig.is_by_pulses());
  CHECK(rig.mean_ms == Approx(5.0).margin(0.1));
  // A sensor that marks its samples allows half a second.
  PulseRig marking(0.0, 0.0);
  marking.marks_pulses = true;
  marking.run(40.0, 30.0);
  CHECK(marking.is_by_pulses());
  CHECK(std::abs(marking.mean_ms) < 0.06);
  CHECK_THAT(marking.stamper.text(), Catch::Contains("of +-500.00 ms that are allowed"));
}

TEST_CASE("Marks that cannot be right are counted and change nothing", "[connect]") {
  PulseRig rig(100.0);
  rig.run(20.0);
  for (int i = 0; i < 30; ++i) {
    const GpsTime now = gps_at(rig.now_ns);
    rig.pulses.push({now.plus_seconds(1e6 + i), 30e-9});
    rig.pulses.push({now.plus_seconds(-1e6 - i), 30e-9});
    rig.pulses.push({now, std::numeric_limits<double>::quiet_NaN()});
    rig.pulses.push({now, 0.5});
    rig.run(1.0);
    CHECK(rig.worst_ms < 0.25);
  }
  CHECK(rig.is_by_pulses());
  CHECK_THAT(rig.stamper.text(), Catch::Contains("30 pulses of no sample") &&
                                     Catch::Contains("60 pulses too uncertain"));
  // Of marks that nobody takes the last ones are kept.
  PulseQueue queue;
  for (int i = 0; i < 1000; ++i) queue.push({gps_at(i), 0.0});
  std::size_t kept = 0;
  while (const auto mark = queue.pop()) {
    if (kept++ == 0) CHECK(mark->time == gps_at(1000 - static_cast<int>(PulseQueue::kCapacity)));
  }
  CHECK(kept == PulseQueue::kCapacity);
}

}  // namespace leonav
