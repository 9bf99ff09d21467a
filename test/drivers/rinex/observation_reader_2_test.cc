#include <cmath>

#include "core/base/calendar.h"
#include "drivers/rinex/rinex_text.h"
#include "support/catch.h"

using namespace leonav;
using namespace leonav::test;

namespace {

std::string header_2(const std::string& types, char system = 'M') {
  return header_line(std::string("     2.11           OBSERVATION DATA    ") + system,
                     "RINEX VERSION / TYPE") +
         types +
         header_line("  2006     3    24    13    10   36.0000000     GPS", "TIME OF FIRST OBS") +
         header_line("", "END OF HEADER");
}
std::string types_2(const std::string& content) {
  return header_line(content, "# / TYPES OF OBSERV");
}

}  // namespace

TEST_CASE("RINEX 2: a scale factor, which is a line of RINEX 3, changes nothing", "[rinex]") {
  const auto read = read_text(
      header_2(types_2("     2    C1    L1") + header_line("C  100   1 C2I", "SYS / SCALE FACTOR") +
               header_line("G  100", "SYS / SCALE FACTOR")) +
      " 06  3 24 13 10 36.1234567  0  1G01\n" + field(2e7) + field(1e8) + "\n");
  REQUIRE(read.epochs.size() == 1);
  CHECK(find(read.epochs[0], "G01", "1C")->pseudorange_m == 2e7);
}

TEST_CASE("RINEX 2: satellite lists over several lines, values over several lines", "[rinex]") {
  std::string text = header_2(types_2("     7    C1    P1    L1    L2    P2    D1    S1")) +
                     " 06  3 24 13 10 36.1234567  0 14G01G02G03G 4G05G06G07G08G09G10R11E12\n"
                     "                                C13 14\n";
  for (int i = 1; i <= 14; ++i) {
    text += field(2e7 + i) + field(2.1e7 + i) + field(1e8 + i, '1', '6') + field(8e7 + i) +
            field(2.2e7 + i) + "\n" + field(1000.0 + i) + (i == 2 ? field(44.0) : "") + "\n";
  }
  const auto read = read_text(text);
  REQUIRE(read.epochs.size() == 1);
  const RawEpoch& epoch = read.epochs[0];
  CHECK(epoch.time == from_calendar({2006, 3, 24, 13, 10, 0.0}).plus_nanoseconds(36'123'456'700));
  CHECK(read.counts.count_of("GLONASS satellite (system not used)") == 1);
  CHECK(read.counts.skipped_total() == 1);
  const SignalObservation* l1 = find(epoch, "G04", "1C");
  REQUIRE(l1 != nullptr);
  CHECK(l1->pseudorange_m == 2e7 + 4);
  CHECK(l1->carrier_cycles == 1e8 + 4);
  CHECK(l1->doppler_hz == 1004.0);
  CHECK(l1->loss_of_lock);
  CHECK(l1->cn0_dbhz == 39.0);  // from the digit
  CHECK(find(epoch, "G02", "1C")->cn0_dbhz == 44.0);
  CHECK(find(epoch, "G04", "1W")->pseudorange_m == 2.1e7 + 4);
  CHECK(std::isnan(find(epoch, "G04", "1W")->carrier_cycles));
  CHECK(find(epoch, "G04", "2W")->pseudorange_m == 2.2e7 + 4);
  CHECK(find(epoch, "G04", "2W")->carrier_cycles == 8e7 + 4);
  CHECK(find(epoch, "G14", "1C")->pseudorange_m == 2e7 + 14);  // blank letter
  CHECK(find(epoch, "E12", "1X")->carrier_cycles == 1e8 + 12);
  CHECK(find(epoch, "C13", "2I")->pseudorange_m == 2e7 + 13);
}

TEST_CASE("RINEX 2: the carrier goes with the code that was measured", "[rinex]") {
  const std::string line = " 98 12 31 23 59 59.0000000  0  2G01G02\n";
  const std::string body = line + field(2e7) + blank_field() + field(1e8) + "\n" + blank_field() +
                           field(2.1e7) + field(1e8) + "\n";
  const auto both = read_text(header_2(types_2("     3    C1    P1    L1")) + body);
  REQUIRE(both.epochs.size() == 1);
  CHECK(both.epochs[0].time == from_calendar({1998, 12, 31, 23, 59, 59.0}));
  CHECK(find(both.epochs[0], "G01", "1C")->carrier_cycles == 1e8);
  CHECK(find(both.epochs[0], "G02", "1W")->carrier_cycles == 1e8);
  const auto only_p =
      read_text(header_2(types_2("     2    P1    L1")) + line + field(2e7) + field(1e8) + "\n\n");
  REQUIRE(only_p.epochs.size() == 1);
  CHECK(find(only_p.epochs[0], "G01", "1W")->carrier_cycles == 1e8);
  const auto l2c =
      read_text(header_2(types_2("     2    C2    L2")) + line + field(2e7) + field(1e8) + "\n\n");
  CHECK(find(l2c.epochs.at(0), "G01", "2X")->carrier_cycles == 1e8);
}

TEST_CASE("RINEX 2: events, and damage from which reading goes on", "[rinex]") {
  const std::string types = types_2("     1    C1");
  const std::string good = " 06  3 24 13 10 36.0000000  0  1G01\n" + field(2e7) + "\n";
  const std::string text = header_2(types) + good + "                            4  1\n" +
                           types_2("     6    L1    C1    D1    S1    P2    L2") +
                           " 06  3 24 13 10 37.0000000  0  2G01G02\n" + field(1e8) + field(2e7) +
                           "\n" + field(8e7) + "\n" +  // second line, then G02 is missing
                           " 06  3 24 13 10 38.0000000  0  1G01\n" + field(1e8) + field(2e7) +
                           "\n\n" + " 06  3 24 13 10 3x.0000000  0  1G01\n" + field(1e8) +
                           field(2e7) + "\n\n" + " 06  3 24 13 10 40.0000000  1  1G01\n" +
                           field(1e8) + field(2e7) + "\n\n" +
                           " 06  3 24 13 10 41.0000000  0  1G01\n" + field(1e8) + "\n";
  const auto read = read_text(text);
  REQUIRE(read.epochs.size() == 4);
  CHECK(find(read.epochs[1], "G01", "1C")->pseudorange_m == 2e7);
  CHECK(find(read.epochs[1], "G01", "2W")->carrier_cycles == 8e7);
  CHECK_FALSE(find(read.epochs[2], "G01", "1C")->loss_of_lock);
  CHECK(find(read.epochs[3], "G01", "1C")->loss_of_lock);
  CHECK(read.counts.count_of("satellite lines that an epoch announces but lacks") == 1);
  CHECK(read.counts.count_of("epoch line that is not readable") == 1);
  CHECK(read.counts.count_of("last epoch, which is cut off") == 1);
}
