// Stamps and samples of inertial readings.
#include <sys/timex.h>

#include <cmath>

#include "stamp_times.h"
#include "support/catch.h"
#include "tools/connect/stamps/imu_sampler.h"
#include "tools/connect/stamps/imu_stamper.h"

namespace leonav {
namespace {

using test::gps_at;
using test::kSecond_ns;
using test::kStart;

// A receiver at 1 Hz whose epochs arrive after 50 ms.
void feed_epochs(GpsClock* clock, int from_s, int to_s) {
  for (int s = from_s; s < to_s; ++s) {
    clock->on_epoch(gps_at(s * kSecond_ns), s * kSecond_ns + 50'000'000);
  }
}

ImuReading reading_at(std::int64_t host_ns, std::int64_t latency_ns) {
  ImuReading reading;
  reading.arrival_ns = host_ns + latency_ns;
  reading.clock_ns = 77 * kSecond_ns + host_ns;
  reading.accel = {0.0, 0.0, -9.8};
  return reading;
}

}  // namespace

TEST_CASE("A sensor's own GPS time is its stamp, and outlives its loss for ten minutes",
          "[connect]") {
  const GpsClock clock(TimeReference::kGnss, 0.05);
  ImuStamper stamper(&clock, {});
  ImuReading reading = reading_at(5 * kSecond_ns, 3'000'000);
  reading.gps_time = gps_at(5 * kSecond_ns);
  CHECK(stamper.stamp(reading) == gps_at(5 * kSecond_ns));
  CHECK(stamper.kind() == ImuStamper::Kind::kGpsTime);
  CHECK(std::isnan(stamper.sigma_s()));
  CHECK(stamper.stamp(reading_at(6 * kSecond_ns, 9'000'000)) == gps_at(6 * kSecond_ns));
  CHECK(stamper.kind() == ImuStamper::Kind::kHeldOffset);
  CHECK_FALSE(stamper.stamp(reading_at(606 * kSecond_ns, 3'000'000)));
}

TEST_CASE("A sensor's own clock is tied to GPS time by arrivals", "[connect]") {
  GpsClock clock(TimeReference::kGnss, 0.05);
  ImuStamper stamper(&clock, {0.004, 0.0});
  std::optional<GpsTime> stamp;
  const auto run = [&](int from_s, int to_s) {
    for (std::int64_t t = from_s * kSecond_ns; t < to_s * kSecond_ns; t += 5'000'000) {
      stamp = stamper.stamp(reading_at(t, 4'000'000 + (t / 5'000'000 % 3) * 1'000'000));
    }
  };
  run(0, 7);
  CHECK_FALSE(stamp);
  CHECK_THAT(stamper.text(), Catch::Contains("no receiver's epoch has come"));
  feed_epochs(&clock, 0, 8);
  run(7, 8);
  REQUIRE(stamp);
  CHECK(std::abs(nanoseconds_between(*stamp, gps_at(8 * kSecond_ns - 5'000'000))) < 1000);
  CHECK(stamper.kind() == ImuStamper::Kind::kLine);
  CHECK_THAT(stamper.text(), Catch::Contains("1 sigma"));

  // A reading whose clock contradicts its arrival is not stamped.
  ImuReading wild = reading_at(8 * kSecond_ns, 4'000'000);
  *wild.clock_ns += 3600 * kSecond_ns;
  CHECK_FALSE(stamper.stamp(wild));
  CHECK(stamper.contradictions() == 1);
}

TEST_CASE("A host that keeps UTC needs no receiver", "[connect]") {
  const GpsClock clock(TimeReference::kHost, 0.05);
  // 2020-12-17 00:00:00 UTC is 1608163200 s since 1970, and 18 s later in GPS time.
  CHECK(clock.at(1'608'163'200 * kSecond_ns) == kStart.plus_seconds(18.0));
}

TEST_CASE("A leap second while the program runs moves no stamp", "[connect]") {
  // 2016-12-31 23:59:50 UTC is 1483228790 s since 1970, and 17 s later in GPS time. The clock of
  // arrivals counts 20 s on, one of which is the leap second.
  const std::int64_t before_ns = 1'483'228'790 * kSecond_ns;
  const GpsClock clock(TimeReference::kHost, 0.05, before_ns);
  const std::optional<GpsTime> before = clock.at(before_ns);
  const std::optional<GpsTime> after = clock.at(before_ns + 20 * kSecond_ns);
  REQUIRE(before);
  REQUIRE(after);
  CHECK(nanoseconds_between(*before, kStart) == (1'483'228'790 - 1'608'163'200 + 17) * kSecond_ns);
  CHECK(nanoseconds_between(*after, *before) == 20 * kSecond_ns);
  // A program that starts afterwards sees a clock that was set: 2017-01-01 00:00:10 UTC.
  const GpsClock later(TimeReference::kHost, 0.05, before_ns + 20 * kSecond_ns);
  CHECK(later.at(before_ns + 20 * kSecond_ns) == after->plus_seconds(1.0));
}

TEST_CASE("A host's clock that is set is followed, and told as a step", "[connect]") {
  GpsClock clock(TimeReference::kHost, 0.05);
  const double step_s = GENERATE(3600.0, -0.03);
  const std::int64_t start_ns = 1'608'163'200 * kSecond_ns;
  const auto wall_minus_arrival_ns = static_cast<std::int64_t>(step_s * 1e9);
  CHECK(clock.at(start_ns) == kStart.plus_seconds(18.0));
  CHECK_FALSE(clock.compare_host(start_ns + kSecond_ns + 100'000, start_ns + kSecond_ns));
  // One comparison alone, as of a thread that waited between both readings, is none.
  std::int64_t now_ns = start_ns + 2 * kSecond_ns;
  CHECK_FALSE(clock.compare_host(now_ns + 500'000'000, now_ns));
  int told = 0;
  for (int k = 0; k < 10; ++k) {
    now_ns += kSecond_ns;
    const auto step = clock.compare_host(now_ns + wall_minus_arrival_ns, now_ns);
    if (!step) continue;
    ++told;
    CHECK(*step == Approx(step_s).margin(1e-6));
    CHECK(k == HostClock::kComparisons - 1);
  }
  CHECK(told == 1);
  CHECK(clock.host_steps() == 1);
  const double since_s = static_cast<double>(now_ns - start_ns) * 1e-9;
  CHECK(seconds_between(*clock.at(now_ns), kStart) == Approx(18.0 + since_s + step_s).margin(1e-6));
}

TEST_CASE("A host's clock without a bound of its error is not synchronised", "[connect]") {
  // As adjtimex(2) answers: by its result, the bound in us, and the status.
  CHECK(HostClock::is_unsynchronised([](timex* answer) {
    answer->maxerror = 16'000'000;
    answer->status = STA_UNSYNC;
    return TIME_ERROR;
  }));
  CHECK_FALSE(HostClock::is_unsynchronised([](timex* answer) {
    answer->maxerror = 31'000;
    return TIME_OK;
  }));
  // As chrony without 'rtcsync' leaves it.
  CHECK_FALSE(HostClock::is_unsynchronised([](timex* answer) {
    answer->maxerror = 31'000;
    answer->status = STA_UNSYNC;
    return TIME_ERROR;
  }));
  // A system that forbids the question.
  CHECK_FALSE(HostClock::is_unsynchronised([](timex* answer) {
    answer->maxerror = 16'000'000;
    return -1;
  }));
}

TEST_CASE("Stamps by a host's clock that is not synchronised are told as such", "[connect]") {
  const auto reference = GENERATE(TimeReference::kHost, TimeReference::kGnss);
  bool is_unsynchronised = true;
  const std::int64_t start_ns = 1'608'163'200 * kSecond_ns;
  GpsClock clock(reference, 0.05, start_ns, [&] { return is_unsynchronised; });
  ImuStamper stamper(&clock, {});
  for (int k = 0; k < 2000; ++k) {
    ImuReading reading;
    reading.clock_ns = k * 10'000'000LL;
    reading.arrival_ns = start_ns + *reading.clock_ns;
    if (k % 100 == 0) clock.on_epoch(kStart.plus_seconds(18.0 + k / 100), reading.arrival_ns);
    stamper.stamp(reading);
  }
  REQUIRE(stamper.kind() == ImuStamper::Kind::kLine);
  const std::string sentence = "the host's clock is not synchronised";
  CHECK((stamper.text().find(sentence) != std::string::npos) ==
        (reference == TimeReference::kHost));
  is_unsynchronised = false;
  CHECK(stamper.text().find(sentence) == std::string::npos);
}

TEST_CASE("A leap second of the host's clock is no step, known or not", "[connect]") {
  const bool is_known = GENERATE(true, false);
  // The end of 2016 had one; that of 2014 stands for one that came after this program was built.
  const std::int64_t midnight_ns = (is_known ? 1'483'228'800 : 1'420'070'400) * kSecond_ns;
  const std::int64_t start_ns = midnight_ns - 10 * kSecond_ns;
  HostClock clock(start_ns);
  const GpsTime before = clock.at(start_ns);
  for (int k = 0; k < 100; ++k) {
    const std::int64_t arrival_ns = start_ns + k * kSecond_ns + 300'000'000;
    const std::int64_t wall_ns = arrival_ns - (arrival_ns >= midnight_ns ? kSecond_ns : 0);
    CHECK_FALSE(clock.compare(wall_ns, arrival_ns));
  }
  CHECK(clock.steps() == 0);
  CHECK(seconds_between(clock.at(start_ns + 100 * kSecond_ns), before) == 100.0);
}

TEST_CASE("A host's clock that contradicts the receiver's epochs is known", "[connect]") {
  GpsClock clock(TimeReference::kHost, 0.05);
  const std::int64_t start_ns = 1'608'163'200 * kSecond_ns;
  // One look each second, with two epochs since the last one, the second of them in time.
  const auto look = [&](int k, double first_delay_s, double second_delay_s) {
    const GpsTime time = kStart.plus_seconds(18.0 + k);
    const std::int64_t arrival_ns = start_ns + k * kSecond_ns;
    clock.on_epoch(time.plus_seconds(-first_delay_s), arrival_ns);
    clock.on_epoch(time.plus_seconds(-second_delay_s), arrival_ns);
    clock.look_at_epochs();
  };
  for (int k = 0; k < 10; ++k) {
    look(k, 0.2, 0.2);
    CHECK_FALSE(clock.host_error_s());
  }
  for (int k = 10; k < 13; ++k) {
    look(k, -20.0, -19.0);
    CHECK(clock.host_error_s().has_value() == (k == 12));
  }
  CHECK(*clock.host_error_s() == Approx(-20.0));
  // Looks without an epoch change nothing; one that agrees ends it.
  clock.look_at_epochs();
  CHECK(clock.host_error_s());
  look(13, 0.2, 0.2);
  CHECK_FALSE(clock.host_error_s());
}

TEST_CASE(
    "A late epoch, and the epochs that a network delivers late at once, do not accuse the host",
    "[connect]") {
  GpsClock clock(TimeReference::kHost, 0.05);
  const std::int64_t start_ns = 1'608'163'200 * kSecond_ns;
  for (int k = 0; k < 100; ++k) {
    const std::int64_t arrival_ns = start_ns + k * kSecond_ns;
    const GpsTime time = kStart.plus_seconds(18.0 + k);
    if (k == 10 || k == 11) {
      clock.on_epoch(time.plus_seconds(-6.0), arrival_ns);
    } else if (k % 10 == 0) {
      for (int late_s = 9; late_s >= 0; --late_s) {
        clock.on_epoch(time.plus_seconds(-late_s), arrival_ns);
      }
    }
    clock.look_at_epochs();
    CHECK_FALSE(clock.host_error_s());
  }
}

TEST_CASE("Rates become increments over the time since the reading before", "[connect]") {
  ImuSampler sampler;
  ImuReading reading;
  reading.gyro = {0.1, 0.0, 0.0};
  reading.accel = {0.0, 0.0, -9.8};
  CHECK_FALSE(sampler.sample(kStart, reading));
  const auto second = sampler.sample(kStart.plus_nanoseconds(5'000'000), reading);
  REQUIRE(second);
  CHECK(second->interval_ns == 5'000'000);
  CHECK(second->delta_theta_b.x() == Approx(0.0005));
  CHECK(second->delta_velocity_b.z() == Approx(-0.049));
  // After a gap a reading covers the usual interval only.
  const auto late = sampler.sample(kStart.plus_nanoseconds(65'000'000), reading);
  REQUIRE(late);
  CHECK(late->interval_ns == 5'000'000);
  CHECK(sampler.counters().gaps == 1);
  // One that does not come later is left out.
  CHECK_FALSE(sampler.sample(kStart.plus_nanoseconds(65'000'000), reading));
  CHECK(sampler.counters().out_of_order == 1);
}

TEST_CASE("Increments keep their own interval, and impossible ones are counted", "[connect]") {
  ImuSampler sampler;
  ImuReading reading;
  reading.are_increments = true;
  reading.interval_s = static_cast<double>(0.005F);
  reading.accel = {0.0, 0.0, -0.049};
  const auto first = sampler.sample(kStart, reading);
  REQUIRE(first);
  CHECK(first->interval_ns == 5'000'000);
  CHECK(first->delta_velocity_b.z() == -0.049);
  double time_s = 1.0;
  for (const double interval_s : {0.0, -0.005, 0.2, 2.0, static_cast<double>(NAN)}) {
    reading.interval_s = interval_s;
    CHECK_FALSE(sampler.sample(kStart.plus_seconds(time_s += 0.005), reading));
  }
  reading.interval_s = 0.005;
  reading.gyro = {1.0, 0.0, 0.0};  // 200 rad/s
  CHECK_FALSE(sampler.sample(kStart.plus_seconds(3.0), reading));
  CHECK(sampler.counters().impossible == 6);
}

}  // namespace leonav
