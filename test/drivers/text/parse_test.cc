#include "drivers/text/parse.h"

#include <filesystem>
#include <fstream>

#include "support/catch.h"

using namespace leonav;

namespace {
std::string write(const std::string& name, const std::string& content) {
  const auto path = std::filesystem::temp_directory_path() / ("leonav_parse_test_" + name);
  std::ofstream(path, std::ios::binary) << content;
  return path.string();
}
}  // namespace

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

TEST_CASE("Lines are counted, line ends stripped, the last one may lack its own", "[text]") {
  LineReader reader(write("lines", "one\r\n\ntwo"));
  std::string_view line;
  REQUIRE(reader.next(line));
  CHECK(line == "one");
  REQUIRE(reader.next(line));
  CHECK(line.empty());
  REQUIRE(reader.next(line));
  CHECK(line == "two");
  CHECK(reader.line_number() == 3);
  CHECK_FALSE(reader.next(line));
  CHECK_FALSE(reader.next(line));
  CHECK_THROWS_WITH(reader.fail("odd"), Catch::Matchers::EndsWith("lines:3: odd"));
  LineReader empty(write("empty", ""));
  CHECK_FALSE(empty.next(line));
}

TEST_CASE("Absent files, folders and binaries are named", "[text]") {
  CHECK_THROWS_WITH(LineReader("/no/such/file.csv"),
                    Catch::Matchers::StartsWith("/no/such/file.csv: cannot be opened"));
  CHECK_THROWS_AS(LineReader(std::filesystem::temp_directory_path().string()), FileError);
  LineReader binary(write("binary", std::string(LineReader::kMaxLineLength + 1, '\1')));
  std::string_view line;
  CHECK_THROWS_AS(binary.next(line), FileError);
}
