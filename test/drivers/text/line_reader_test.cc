#include "drivers/text/line_reader.h"

#include <filesystem>
#include <string>

#include "support/catch.h"
#include "support/temporary_file.h"

using namespace leonav;

TEST_CASE("Lines are counted, line ends stripped, the last one may lack its own", "[text]") {
  const test::TemporaryFile lines("lines", "one\r\n\ntwo");
  LineReader reader(lines.path());
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
  const test::TemporaryFile nothing("empty", "");
  LineReader empty(nothing.path());
  CHECK_FALSE(empty.next(line));
}

TEST_CASE("Absent files, folders and binaries are named", "[text]") {
  CHECK_THROWS_WITH(LineReader("/no/such/file.csv"),
                    Catch::Matchers::StartsWith("/no/such/file.csv: cannot be opened"));
  CHECK_THROWS_AS(LineReader(std::filesystem::temp_directory_path().string()), FileError);
  const test::TemporaryFile file("binary", std::string(LineReader::kMaxLineLength + 1, '\1'));
  LineReader binary(file.path());
  std::string_view line;
  CHECK_THROWS_AS(binary.next(line), FileError);
}

TEST_CASE("One line can be given back", "[text]") {
  const test::TemporaryFile file("lines", "one\ntwo\n");
  LineReader reader(file.path());
  std::string_view line;
  REQUIRE(reader.next(line));
  reader.step_back();
  REQUIRE(reader.next(line));
  CHECK(line == "one");
  CHECK(reader.line_number() == 1);
  REQUIRE(reader.next(line));
  CHECK(line == "two");
}

TEST_CASE("Compressed files are refused with the program that unpacks them", "[text]") {
  const test::TemporaryFile gzip("a.obs.gz", "\x1f\x8b\x08 and so on");
  CHECK_THROWS_WITH(LineReader(gzip.path()), Catch::Matchers::EndsWith("unpack it with gunzip"));
  const test::TemporaryFile compress("a.obs.Z", "\x1f\x9d\x90 and so on");
  CHECK_THROWS_WITH(LineReader(compress.path()),
                    Catch::Matchers::EndsWith("unpack it with uncompress"));
  const test::TemporaryFile two("two", "\x1f\x8b");
  CHECK_THROWS_AS(LineReader(two.path()), FileError);
}
