#include "drivers/rinex/observation_reader.h"

#include <algorithm>
#include <cmath>

#include "core/base/calendar.h"
#include "drivers/rinex/rinex_text.h"
#include "drivers/text/parse.h"
#include "support/catch.h"

using namespace leonav;
using namespace leonav::test;

namespace {

const std::string kTypesG = types_3("G    4 C1C L1C D1C S1C");
const GpsTime kMinute = from_calendar({2024, 5, 6, 7, 8, 0.0});

std::string message_of(const std::string& text) {
  try {
    read_text(text);
  } catch (const FileError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("RINEX 3: fields lie in their columns", "[rinex]") {
  // A line as a phone writes it: digits without a blank before them.
  const auto read = read_text(
      header_3("3.03", types_3("G    8 C1C L1C D1C S1C C5X L5X D5X S5X")) +
      "> 2024 05 06 07 08 22.4299102  0  1\n"
      "G06  22542877.93724        -0.00024     -2926.05024        26.40024  22540519.77005"
      "      7322.44935     -2184.66505        31.00005\n");
  REQUIRE(read.epochs.size() == 1);
  CHECK(read.epochs[0].time == kMinute.plus_nanoseconds(22'429'910'200));
  REQUIRE(read.epochs[0].observations.size() == 2);
  const SignalObservation& l1 = read.epochs[0].observations[0];
  CHECK(l1.pseudorange_m == 22542877.937);
  CHECK(std::isnan(l1.carrier_cycles));
  CHECK(l1.half_cycle_ambiguous);
  CHECK_FALSE(l1.loss_of_lock);
  CHECK(l1.doppler_hz == -2926.050);
  const SignalObservation& l5 = read.epochs[0].observations[1];
  CHECK(to_string(l5.code) == "5X");
  CHECK(l5.pseudorange_m == 22540519.770);
  CHECK(l5.carrier_cycles == 7322.449);
  CHECK(l5.loss_of_lock);
  CHECK(l5.half_cycle_ambiguous);
  CHECK(l5.cn0_dbhz == 31.0);
  CHECK(std::isnan(l5.lock_time_s));
}

TEST_CASE("RINEX 3: continued type lists, scale factors, strength digits", "[rinex]") {
  const auto read = read_text(
      header_3("3.04", types_3("G   14 C1C L1C D1C S1C C1W L1W D1W S1W C2W L2W D2W S2W C5Q") +
                           types_3("       L5Q") +
                           header_line("G  100   2 L5Q C5Q", "SYS / SCALE FACTOR")) +
      epoch_3("1.0000000", 0, 1) + "G01" + field(2e7, ' ', '7') + field(1e8, ' ', '8') +
      [] {
        std::string blanks;
        for (int i = 0; i < 10; ++i) blanks += blank_field();
        return blanks;
      }() +
      field(2'000'000'012.3) + field(7'700'000'055.5) + "\n");
  REQUIRE(read.epochs.size() == 1);
  REQUIRE(read.epochs[0].observations.size() == 2);
  CHECK(find(read.epochs[0], "G01", "1C")->cn0_dbhz == 51.0);  // carrier's digit before code's
  CHECK(find(read.epochs[0], "G01", "5Q")->pseudorange_m == 20'000'000.123);
  CHECK(find(read.epochs[0], "G01", "5Q")->carrier_cycles == 77'000'000.555);
}

TEST_CASE("RINEX 3: scale factors of LEO go by the letter of the list", "[rinex]") {
  const auto range = [](const std::string& letter) {
    const auto read =
        read_text(header_3("3.05", types_3("O    2 C1C L1C") + header_line(letter + "  100   1 C1C",
                                                                           "SYS / SCALE FACTOR")) +
                  epoch_3("1.0000000", 0, 1) + "O07" + field(2e8) + field(1e7) + "\n");
    return read.epochs.at(0).observations.at(0).pseudorange_m;
  };
  CHECK(range("O") == 2e6);
  CHECK(range("L") == 2e8);
}

TEST_CASE("RINEX 3: BeiDou's B1I goes by the version", "[rinex]") {
  const std::string body = epoch_3("1.0000000", 0, 1) + "C21" + field(3e7) + "\n";
  const auto code = [&body](const std::string& version, const std::string& type) {
    const auto read = read_text(header_3(version, types_3("C    1 " + type)) + body);
    return to_string(read.epochs.at(0).observations.at(0).code);
  };
  CHECK(code("3.01", "C2I") == "2I");
  CHECK(code("3.02", "C1I") == "2I");
  CHECK(code("3.02", "C1X") == "2X");
  CHECK(code("3.04", "C2I") == "2I");
  CHECK(code("3.04", "C1X") == "1X");
  CHECK(code("3.05", "C1P") == "1P");
}

TEST_CASE("RINEX 3: LEO letters share the types of L", "[rinex]") {
  const auto read = read_text(header_3("3.05", types_3("L    1 C1C")) + epoch_3("1.0000000", 0, 4) +
                              "O07" + field(2e6) + "\nL01" + field(2e6) + "\nN99" + field(2e6) +
                              "\nM00" + field(2e6) + "\n");
  REQUIRE(read.epochs.size() == 1);
  std::vector<int> numbers;
  for (const auto& o : read.epochs[0].observations) numbers.push_back(o.satellite.number);
  CHECK(numbers == std::vector<int>{1, 100, 299, 307});
}

TEST_CASE("RINEX 3: time systems", "[rinex]") {
  const std::string body = epoch_3("1.0000000", 0, 1) + "G01" + field(2e7) + "\n";
  const auto time = [&](const std::string& system) {
    return seconds_between(read_text(header_3("3.05", kTypesG, system) + body).epochs.at(0).time,
                           kMinute);
  };
  CHECK(time("GPS") == 1.0);
  CHECK(time("GAL") == 1.0);
  CHECK(time("   ") == 1.0);
  CHECK(time("BDT") == 15.0);
  CHECK(time("GLO") == 19.0);
  CHECK(time("UTC") == 19.0);
  CHECK(message_of(header_3("3.05", kTypesG, "XYZ") + body).find("time system 'XYZ'") !=
        std::string::npos);
}

TEST_CASE("RINEX 3: other systems and damage are counted, the rest is kept", "[rinex]") {
  const auto read = read_text(
      header_3("3.05", kTypesG) + epoch_3("1.0000000", 0, 7) + "R01" + field(2e7) + "\nJ01" +
      field(2e7) + "\nG02" + field(2e7) + "\nG01  2x000000.000  " + field(1e8) + "\nG02" +
      field(3e7) + "\nE01" + field(2e7) + "\nG9?" + field(2e7) + "\n> garbage\nG01" + field(1e7) +
      "\n" + epoch_3("2.0000000", 0, 2) + "G05" + field(2e7) + "\n" +  // one line is missing
      epoch_3("2.0000000", 0, 1) + "G05" + field(2e7) + "\n" + epoch_3("3.0000000", 0, 1) + "G05" +
      field(2e7) + "\n");
  REQUIRE(read.epochs.size() == 4);  // order in time is for the caller
  CHECK(read.epochs[0].observations.size() == 2);
  CHECK(std::isnan(find(read.epochs[0], "G01", "1C")->pseudorange_m));
  CHECK(find(read.epochs[0], "G01", "1C")->carrier_cycles == 1e8);
  CHECK(find(read.epochs[0], "G02", "1C")->pseudorange_m == 2e7);
  CHECK(read.counts.used == 4);
  CHECK(read.counts.count_of("GLONASS satellite (system not used)") == 1);
  CHECK(read.counts.count_of("QZSS satellite (system not used)") == 1);
  CHECK(read.counts.count_of("value that is not readable") == 1);
  CHECK(read.counts.count_of("satellite that is twice in an epoch") == 1);
  CHECK(read.counts.count_of("satellite of a system without observation types in the header") == 1);
  CHECK(read.counts.count_of("satellite name that is not readable") == 1);
  CHECK(read.counts.count_of("epoch line that is not readable") == 1);
  CHECK(read.counts.count_of("satellite lines that an epoch announces but lacks") == 1);
  CHECK(read.counts.skipped_total() == 8);
}

TEST_CASE("RINEX 3: events, header lines within the file, power failure", "[rinex]") {
  const auto read = read_text(
      header_3("3.05", kTypesG) + epoch_3("1.0000000", 0, 1) + "G01" + field(2e7) + field(1e8) +
      "\n>                              4  2\n" + header_line("moved", "COMMENT") +
      types_3("G    2 L1C C1C") + epoch_3("2.0000000", 6, 1) + "G01" + field(4e7) + "\n" +
      epoch_3("3.0000000", 1, 1) + "G01" + field(1e8) + field(2e7) + "\n" +
      epoch_3("4.0000000", 0, 2) + "G01" + field(1e8) + field(2e7) + "\nG02" + field(1e8) +
      field(2e7) + "\n" + epoch_3("5.0000000", 5, 0) + epoch_3("6.0000000", 0, 2) + "G01" +
      field(1e8) + field(2e7) + "\nG02" + field(1e8) + field(2e7) + "\n");
  REQUIRE(read.epochs.size() == 4);
  CHECK(read.counts.skipped.empty());
  for (const RawEpoch& epoch : read.epochs) {
    CHECK(epoch.observations[0].pseudorange_m == 2e7);
    CHECK(epoch.observations[0].carrier_cycles == 1e8);
  }
  CHECK_FALSE(read.epochs[0].observations[0].loss_of_lock);
  CHECK(find(read.epochs[1], "G01", "1C")->loss_of_lock);
  CHECK_FALSE(find(read.epochs[2], "G01", "1C")->loss_of_lock);
  CHECK(find(read.epochs[2], "G02", "1C")->loss_of_lock);  // not seen since the failure
  CHECK_FALSE(find(read.epochs[3], "G02", "1C")->loss_of_lock);
}

TEST_CASE("RINEX 3: a loss of lock without a carrier holds until the carrier is back", "[rinex]") {
  const auto read = read_text(header_3("3.05", kTypesG) + epoch_3("1.0000000", 0, 1) + "G01" +
                              field(2e7) + "              1 \n" + epoch_3("2.0000000", 0, 1) +
                              "G01" + field(2e7) + field(1e8) + "\n");
  REQUIRE(read.epochs.size() == 2);
  CHECK(read.epochs[0].observations[0].loss_of_lock);
  CHECK(read.epochs[1].observations[0].loss_of_lock);
}

TEST_CASE("RINEX 3: more satellites than fit are counted by name, the first frequency is kept",
          "[rinex]") {
  std::string body = epoch_3("1.0000000", 0, 399);
  for (int i = 1; i <= 399; ++i) {
    char name[8];
    std::snprintf(name, sizeof name, "%c%02d", "LMNO"[i / 100], i % 100);
    body += name + field(2e6) + field(2.1e6) + "\n";
  }
  const auto read = read_text(header_3("3.05", types_3("L    2 C1C C2W")) + body);
  REQUIRE(read.epochs.size() == 1);
  CHECK(read.epochs[0].observations.size() == kMaxObservations);
  CHECK(read.losses.usable == 798 - kMaxObservations);
  CHECK(read.losses.spare == 0);
  CHECK(usable_text(read.losses).starts_with("signal beyond the 512 that an epoch holds (leo 2W)"));
  const auto& kept = read.epochs[0].observations;
  CHECK(std::count_if(kept.begin(), kept.end(),
                      [](const SignalObservation& o) { return o.code.band == '1'; }) == 399);
}

TEST_CASE("RINEX 3: a satellite keeps its signals, however many come before in the header",
          "[rinex]") {
  // Thirteen columns to a line, twelve of which the navigator would rather not have before L2 P(Y).
  const std::string types = header_line(
      "G   13 C1X C1L C1S C2X C2L C2S C5X C5I C1P C5Q C2P C1W C1C", "SYS / # / OBS TYPES");
  std::string fields;
  for (int i = 0; i < 13; ++i) fields += field(2e7 + i);
  const auto one =
      read_text(header_3("3.05", types) + epoch_3("1.0000000", 0, 1) + "G01" + fields + "\n");
  REQUIRE(one.epochs.size() == 1);
  CHECK(one.epochs[0].observations.size() == 13);
  CHECK(one.counts.skipped.empty());
  REQUIRE(find(one.epochs[0], "G01", "1C") != nullptr);
  CHECK(find(one.epochs[0], "G01", "1C")->pseudorange_m == 2e7 + 12);

  std::string body = epoch_3("1.0000000", 0, 60);
  for (int i = 1; i <= 60; ++i) {
    char name[8];
    std::snprintf(name, sizeof name, "G%02d", i);
    body += name + fields + "\n";
  }
  const auto many = read_text(header_3("3.05", types) + body);
  REQUIRE(many.epochs.size() == 1);
  CHECK(many.epochs[0].observations.size() == kMaxObservations);
  CHECK(many.losses.usable == 0);
  CHECK(many.losses.spare == 60 * 13 - kMaxObservations);
  CHECK(spare_text(many.losses).find("gps 1L 1S") != std::string::npos);
  for (int i = 1; i <= 60; ++i) {
    char name[8];
    std::snprintf(name, sizeof name, "G%02d", i);
    for (const char* code : {"1C", "2P", "5X"}) CHECK(find(many.epochs[0], name, code) != nullptr);
  }
}

TEST_CASE("a file cut off at any byte keeps its whole epochs and no wrong value", "[rinex]") {
  std::string whole = header_3("3.05", kTypesG);
  const std::size_t header_size = whole.size();
  for (int i = 1; i <= 3; ++i) {
    whole += epoch_3(std::to_string(i) + ".0000000", 0, 2) + "G01" + field(21234567.891) +
             field(112345678.912) + "\nG02" + field(23456789.123) + "\n";
  }
  for (std::size_t size = header_size; size <= whole.size(); ++size) {
    const auto read = read_text(whole.substr(0, size));
    CHECK(static_cast<long>(read.epochs.size()) == read.counts.used);
    for (const RawEpoch& epoch : read.epochs) {
      for (const SignalObservation& o : epoch.observations) {
        const double expected = o.satellite.number == 1 ? 21234567.891 : 23456789.123;
        CHECK((std::isnan(o.pseudorange_m) || o.pseudorange_m == expected));
        CHECK((std::isnan(o.carrier_cycles) || o.carrier_cycles == 112345678.912));
      }
    }
    if (size == whole.size() - 20) {
      CHECK(read.epochs.size() == 2);
      CHECK(read.counts.count_of("last epoch, which is cut off") == 1);
    }
  }
}

TEST_CASE("what is no RINEX observation file is refused with file, line and remedy", "[rinex]") {
  const auto refused = [](const std::string& text, const std::string& word) {
    const std::string message = message_of(text);
    INFO(message);
    CHECK(message.find("test.obs") != std::string::npos);
    CHECK(message.find(word) != std::string::npos);
  };
  refused("", "empty");
  refused("hello\n", "RINEX VERSION / TYPE");
  refused(std::string("\x1f\x8b\x08junk"), "gunzip");
  refused(header_line("1.0                 COMPACT RINEX FORMAT", "CRINEX VERS   / TYPE"),
          "crx2rnx");
  refused(header_line("     4.00           OBSERVATION DATA    M", "RINEX VERSION / TYPE"), "4.00");
  refused(header_line("     3.05           N: GNSS NAV DATA    M", "RINEX VERSION / TYPE"),
          "not an observation file");
  refused(header_line("     3.05           OBSERVATION DATA    M", "RINEX VERSION / TYPE"),
          "within its header");
  refused(header_3("3.05", ""), "no observation types");
  refused(header_3("3.05", types_3("G    5 C1C L1C")), "announces 5");
  refused(header_3("3.05", types_3("G   xx C1C L1C")), "not readable");
  CHECK_THROWS_AS(ObservationReader("/no/such/file.obs"), FileError);
  CHECK(read_text(header_3("3.05", kTypesG)).counts.used == 0);
}
