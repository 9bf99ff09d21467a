// Lock time indicators against the rows of the standard's tables, and what they say of a carrier.
#include "drivers/rtcm3/msm_lock_time.h"

#include "support/catch.h"

namespace leonav {
namespace {

const GpsTime kStart = GpsTime::from_week_and_tow(2200, 1000.0);

MsmLock lock(double after_s, std::int64_t least_ms) {
  return {kStart.plus_seconds(after_s), least_ms};
}

}  // namespace

TEST_CASE("Lock time indicators give the least times of the standard's tables") {
  CHECK(least_lock_ms(0) == 0);
  CHECK(least_lock_ms(1) == 32);
  CHECK(least_lock_ms(2) == 64);
  CHECK(least_lock_ms(6) == 1024);
  CHECK(least_lock_ms(15) == 524'288);
  // Rows of table 3.5-75: 2 i - 64, 4 i - 256, 8 i - 768, ...
  CHECK(least_lock_extended_ms(0) == 0);
  CHECK(least_lock_extended_ms(63) == 63);
  CHECK(least_lock_extended_ms(64) == 64);
  CHECK(least_lock_extended_ms(95) == 2 * 95 - 64);
  CHECK(least_lock_extended_ms(96) == 4 * 96 - 256);
  CHECK(least_lock_extended_ms(127) == 4 * 127 - 256);
  CHECK(least_lock_extended_ms(128) == 8 * 128 - 768);
  CHECK(least_lock_extended_ms(480) == 16384LL * 480 - 7'340'032);
  CHECK(least_lock_extended_ms(671) == 524288LL * 671 - 318'767'104);
  CHECK(least_lock_extended_ms(703) == 1048576LL * 703 - 671'088'640);
  CHECK(least_lock_extended_ms(704) == 67'108'864);
  CHECK(least_lock_extended_ms(1023) == 67'108'864);
  for (std::uint32_t i = 0; i < 704; ++i) {
    CHECK(least_lock_extended_ms(i) < least_lock_extended_ms(i + 1));
  }
}

TEST_CASE("A carrier is interrupted where its lock cannot be shown to be older than the last one") {
  CHECK_FALSE(lock_was_lost({}, lock(0, 4096)));  // a first carrier interrupts nothing
  CHECK(lock_was_lost({}, lock(0, 0)));
  CHECK_FALSE(lock_was_lost(lock(0, 4096), lock(1, 4096)));
  CHECK_FALSE(lock_was_lost(lock(0, 4096), lock(1, 8192)));
  CHECK(lock_was_lost(lock(0, 4096), lock(1, 2048)));    // it went back
  CHECK(lock_was_lost(lock(0, 4096), lock(30, 16384)));  // younger than the gap
  CHECK_FALSE(lock_was_lost(lock(0, 4096), lock(30, 32768)));
  CHECK(lock_was_lost(lock(0, 4096), lock(-1, 4096)));  // time went back
}

}  // namespace leonav
