// The position for casters, against lines worked out by hand.
#include "tools/connect/position_line.h"

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "support/catch.h"

namespace leonav {

TEST_CASE("A position is a GGA sentence with a fix", "[connect]") {
  // 2024-03-20 12:00:18 GPS time is 12:00:00 UTC. The checksum is that of the characters between.
  const GpsTime noon = from_calendar({2024, 3, 20, 12, 0, 18.0});
  CHECK(position_line({52.5 * kDegree, -13.25 * kDegree, 80.125}, noon) ==
        "$GPGGA,120000.00,5230.000000,N,01315.000000,W,1,12,1.0,80.125,M,0.0,M,,*73\r\n");
  CHECK(position_line_now({0.0, 0.0, 0.0}).starts_with("$GPGGA,"));
}

}  // namespace leonav
