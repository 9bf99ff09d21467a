// The table of cold starts: what is counted, and of what a share is.
#include <algorithm>
#include <sstream>
#include <vector>

#include "core/base/angle.h"
#include "support/catch.h"
#include "tools/starts/start_list.h"
#include "tools/starts/start_tables.h"

namespace leonav::test {
namespace {

StartResult start(InitialMotion way, double aligned_s, double error, double error_at_end) {
  StartResult result;
  result.start = GpsTime::from_week_and_tow(2136, 345'600.0);
  result.way = way;
  result.with_gnss_30_s = 30.0;
  result.driven_30_s = way == InitialMotion::kStanding ? 0.0 : 30.0;
  for (double s = aligned_s; s < 60.0; ++s)
    result.heading.add(s, (s < 45.0 ? error : error_at_end) * kDegree, 0.01);
  return result;
}

std::string row_of(const std::string& table, const std::string& name) {
  const std::size_t at = table.find("\n" + name);
  if (at == std::string::npos) return "";
  return table.substr(at + 1, table.find('\n', at + 1) - at - 1);
}

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

}  // namespace

TEST_CASE("false starts and those carried away are counted by themselves") {
  const std::vector<StartResult> results = {start(InitialMotion::kCurve, 8, 0.5, 0.5),
                                            start(InitialMotion::kCurve, 8, 20.0, 20.0),
                                            start(InitialMotion::kCurve, 8, 0.5, 20.0)};
  std::ostringstream out;
  CHECK(print_table(results, out) == 2);
  const auto words = words_of(row_of(out.str(), "in a curve"));
  REQUIRE(words.size() > 4);
  CHECK(words.back() == "1");                // carried away
  CHECK(*std::prev(words.end(), 2) == "1");  // false
}

TEST_CASE("whoever cannot align is in the share of all, not in that of the able") {
  StartResult waits = start(InitialMotion::kStanding, 60, 0.0, 0.0);
  REQUIRE(cannot_align(waits));
  std::ostringstream out;
  CHECK(print_table(std::vector<StartResult>{waits, start(InitialMotion::kStanding, 12, 0.5, 0.5)},
                    out) == 0);
  auto words = words_of(row_of(out.str(), "standing"));
  REQUIRE(words.size() > 7);
  CHECK(words[1] == "2");
  CHECK(words[2] == "1");
  CHECK(words[3] == "50");
  CHECK(words[5] == "100");
  std::ostringstream none;
  CHECK(print_table(std::vector<StartResult>{waits}, none) == 0);
  words = words_of(row_of(none.str(), "standing"));
  CHECK(words[3] == "0");
  CHECK(words[5] == "-");  // a share of nobody
  waits.gyros_find_north = true;
  CHECK_FALSE(cannot_align(waits));
  waits.with_gnss_30_s = 5.0;
  CHECK(cannot_align(waits));
}

TEST_CASE("the list has a field for each of its names") {
  const std::vector<StartResult> results = {start(InitialMotion::kStraight, 8, 0.5, 20.0),
                                            start(InitialMotion::kStraight, 60, 0.0, 0.0)};
  std::ostringstream out;
  write_start_list(results, out);
  std::istringstream in(out.str());
  std::string line;
  std::vector<long> commas;
  while (std::getline(in, line)) commas.push_back(std::count(line.begin(), line.end(), ','));
  REQUIRE(commas.size() == 3);
  CHECK(commas[1] == commas[0]);
  CHECK(commas[2] == commas[0]);
}

}  // namespace leonav::test
