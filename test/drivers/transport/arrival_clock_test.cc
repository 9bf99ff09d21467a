// The clock of arrivals against both clocks of the host.
#include "drivers/transport/arrival_clock.h"

#include <cstdlib>

#include "support/catch.h"

namespace leonav {

TEST_CASE("The clock of arrivals begins with the wall clock and goes on with the steady one",
          "[transport]") {
  const ArrivalClock clock;
  const std::chrono::nanoseconds wall = std::chrono::system_clock::now().time_since_epoch();
  constexpr std::int64_t kSecond = 1'000'000'000;
  CHECK(std::abs(clock.now_ns() - wall.count()) < kSecond);
  CHECK(std::abs(clock.wall_lead_ns()) < kSecond / 10);
  const auto now = ArrivalClock::Steady::now();
  CHECK(clock.at_ns(now + std::chrono::seconds(3)) - clock.at_ns(now) == 3 * kSecond);
}

}  // namespace leonav
