// A log line is written when its value changes, and not again while the value stays the same.
#include "daemon/supervision/changed.h"

#include <optional>
#include <string>

#include "support/catch.h"

using namespace leonav;

TEST_CASE("a value has changed at the look at which it is another one, and at no other") {
  Changed<std::string> error;
  CHECK_FALSE(error.look(""));
  CHECK(error.look("no space"));
  CHECK_FALSE(error.look("no space"));
  CHECK(error.look("no folder"));
  CHECK(error.look(""));
  CHECK_FALSE(error.look(""));
}

TEST_CASE("the first value of what need not be there has changed, whatever it is") {
  Changed<std::optional<int>> status;
  CHECK(status.look(0));
  CHECK_FALSE(status.look(0));
  CHECK(status.look(1));
}
