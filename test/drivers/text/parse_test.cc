#include "drivers/text/parse.h"

#include "support/catch.h"

using namespace leonav;

TEST_CASE("Numbers are read strictly", "[text]") {
  CHECK(parse_double(" -1.25 ") == -1.25);
  CHECK(parse_double("+3") == 3.0);
  CHECK(parse_double("-.123456789012D-05") == -0.123456789012e-5);
  CHECK(parse_double(" 1.5d+01") == 15.0);
  CHECK(parse_double("2e3") == 2000.0);
  for (const char* bad : {"", "  ", "x", "1x", "1 2", "+-1", "++1", "nan", "inf", "-INF", "0x10",
                          "1e999", "1,5", "--1", "1e", "D", "."}) {
    INFO(bad);
    CHECK_FALSE(parse_double(bad));
  }
  CHECK_FALSE(parse_double(std::string(100, '1')));
  CHECK_FALSE(parse_double(std::string_view("1\0", 2)));
  CHECK(parse_int(" 42 ") == 42);
  CHECK(parse_int("-7") == -7);
  CHECK(parse_int("+7") == 7);
  for (const char* bad : {"", "4.0", "99999999999", "1e3", "7 7", "a", "+-3"}) {
    INFO(bad);
    CHECK_FALSE(parse_int(bad));
  }
}

TEST_CASE("Columns beyond the end of a line are missing", "[text]") {
  CHECK(columns("abcdef", 2, 3) == "cde");
  CHECK(columns("abcdef", 4, 10) == "ef");
  CHECK(columns("abc", 3, 1).empty());
  CHECK(columns("", 100, 1).empty());
}

TEST_CASE("Commas split, blanks go", "[text]") {
  std::vector<std::string_view> fields{"old"};
  split_csv("a, b ,,c,", fields);
  CHECK(fields == std::vector<std::string_view>{"a", "b", "", "c", ""});
  split_csv("", fields);
  CHECK(fields == std::vector<std::string_view>{""});
}
