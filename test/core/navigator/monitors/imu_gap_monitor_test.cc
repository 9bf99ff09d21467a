#include "core/navigator/monitors/imu_gap_monitor.h"

#include "support/catch.h"
#include "support/sky/simulated_sky.h"

namespace leonav {
namespace {

constexpr std::int64_t kMs = 1'000'000;

GpsTime at_ms(std::int64_t ms) { return test::kSkyEpoch.plus_nanoseconds(ms * kMs); }

// An epoch at `ms` with samples of 10 ms that end in (from, to].
EpochWork epoch(std::int64_t ms, std::int64_t from_ms, std::int64_t to_ms) {
  EpochWork work;
  work.time = at_ms(ms);
  for (std::int64_t end = from_ms + 10; end <= to_ms; end += 10) {
    ImuSample sample;
    sample.time = at_ms(end);
    sample.interval_ns = 10 * kMs;
    work.block.push_back(sample);
  }
  return work;
}

TEST_CASE("a gap of more than three seconds is returned once, as soon as an epoch shows it") {
  ImuGapMonitor gaps;
  CHECK_FALSE(gaps.add(epoch(1000, 0, 0)));  // there has been no sample to begin a gap
  CHECK_FALSE(gaps.add(epoch(2000, 1000, 2000)));
  CHECK_FALSE(gaps.add(epoch(3000, 2000, 2500)));
  CHECK_FALSE(gaps.add(epoch(4000, 0, 0)));
  CHECK_FALSE(gaps.add(epoch(5500, 0, 0)));
  CHECK(gaps.add(epoch(6000, 0, 0)) == 3.5);
  CHECK_FALSE(gaps.add(epoch(6500, 0, 0)));
  CHECK_FALSE(gaps.add(epoch(7000, 6600, 7000)));
  CHECK_FALSE(gaps.add(epoch(8000, 7000, 8000)));
}

TEST_CASE("a gap of three seconds that ends within a block is no reason") {
  ImuGapMonitor gaps;
  CHECK_FALSE(gaps.add(epoch(1000, 0, 1000)));
  CHECK_FALSE(gaps.add(epoch(5000, 4000, 5000)));
  CHECK(gaps.add(epoch(10'000, 8500, 10'000)) == 3.5);  // a longer one is
}

}  // namespace
}  // namespace leonav
