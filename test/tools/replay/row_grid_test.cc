// Which rows a table at a rate has.
#include "tools/replay/row_grid.h"

#include "support/catch.h"

namespace leonav::test {

TEST_CASE("rows at a rate begin anew where time goes back, and not for one that is late") {
  const auto at = [](double seconds) {
    return GpsTime::from_nanoseconds(1'000'000'000'000'000LL).plus_seconds(seconds);
  };
  RowGrid grid(1.0);
  CHECK(grid.takes(at(0.0)));
  CHECK_FALSE(grid.takes(at(0.9)));
  CHECK(grid.takes(at(1.02)));
  CHECK_FALSE(grid.takes(at(1.5)));
  CHECK_FALSE(grid.takes(at(1.49)));  // late by a sample
  CHECK(grid.takes(at(2.0)));
  CHECK(grid.takes(at(0.3)));  // another drive
  CHECK_FALSE(grid.takes(at(0.8)));
  CHECK(grid.takes(at(1.0)));
}

}  // namespace leonav::test
