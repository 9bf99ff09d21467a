#include "drivers/blq/blq_reader.h"

#include <numbers>

#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/temporary_file.h"

namespace leonav {
namespace {

const std::string kBlqHeader =
    "$$ Ocean loading displacement\n"
    "$$\n"
    "$$ COLUMN ORDER:  M2  S2  N2  K2  K1  O1  P1  Q1  MF  MM SSA\n"
    "$$ ROW ORDER: AMPLITUDES (m) RADIAL, TANGENTL EW, TANGENTL NS, PHASES (deg) likewise\n"
    "$$ END HEADER\n"
    "$$\n";
// The example of the format's description: Onsala, GOT00.2.
const std::string kOnsala =
    "  ONSALA\n"
    "$$ Onsala,                          lon/lat:   11.9264   57.3958    0.000\n"
    "  .00352 .00123 .00080 .00032 .00187 .00112 .00063 .00003 .00082 .00044 .00037\n"
    "  .00144 .00035 .00035 .00008 .00053 .00049 .00018 .00009 .00012 .00005 .00006\n"
    "  .00086 .00023 .00023 .00006 .00029 .00028 .00010 .00007 .00004 .00002 .00001\n"
    "   -64.7  -52.0  -96.2  -55.2  -58.8 -151.4  -65.6 -138.1    8.4    5.2    2.1\n"
    "    85.5  114.5   56.5  113.6   99.4   19.1   94.1  -10.4 -167.4 -170.0 -177.7\n"
    "   109.5  147.0   92.7  148.8   50.5  -55.1   36.4 -170.4  -15.0    2.3    5.2\n";
// Made up: every number says its row and column.
const std::string kOther =
    "  7840 13212S001\n"
    "  .01001 .01002 .01003 .01004 .01005 .01006 .01007 .01008 .01009 .01010 .01011\n"
    "  .02001 .02002 .02003 .02004 .02005 .02006 .02007 .02008 .02009 .02010 .02011\n"
    "  .03001 .03002 .03003 .03004 .03005 .03006 .03007 .03008 .03009 .03010 .03011\n"
    "   101.1  102.1  103.1  104.1  105.1  106.1  107.1  108.1  109.1  110.1  111.1\n"
    "$$ a remark between rows\n"
    "   201.1  202.1  203.1  204.1  205.1  206.1  207.1  208.1  209.1  210.1  211.1\n"
    "   301.1  302.1  303.1  304.1  305.1  306.1  307.1  308.1  309.1  310.1  311.1\n";
const std::string kEndOfTable = "$$ END TABLE\n";
constexpr int kHeaderLines = 6;

BlqStation read_blq_text(const std::string& text, const std::string& station) {
  const test::TemporaryFile file("test.blq", text);
  return read_blq(file.path(), station);
}

std::string replaced(std::string text, const std::string& old, const std::string& with) {
  const std::size_t at = text.find(old);
  REQUIRE(at != std::string::npos);
  return text.replace(at, old.size(), with);
}

std::string without_line(const std::string& text, const std::string& begin) {
  const std::size_t at = text.find(begin);
  REQUIRE(at != std::string::npos);
  return std::string(text).erase(at, text.find('\n', at) + 1 - at);
}

std::string error_of(const std::string& text, const std::string& station) {
  const test::TemporaryFile file("test.blq", text);
  try {
    read_blq(file.path(), station);
  } catch (const FileError& error) {
    const std::string what = error.what();
    CHECK(what.starts_with(file.path() + ":"));
    return what.substr(file.path().size());
  }
  return "(no error)";
}

}  // namespace

TEST_CASE("each station of a BLQ file is found, row by row and wave by wave", "[blq]") {
  const std::string text = kBlqHeader + kOnsala + kEndOfTable + kOther + kEndOfTable;
  const BlqStation onsala = read_blq_text(text, "ONSALA");
  CHECK(onsala.name == "ONSALA");
  CHECK(onsala.line == kHeaderLines + 1);
  CHECK(onsala.rows(0, 0) == 0.00352);
  CHECK(onsala.rows(2, 10) == 0.00001);
  CHECK(onsala.rows(3, 0) == -64.7);
  CHECK(onsala.rows(5, 10) == 5.2);
  const BlqStation other = read_blq_text(text, "7840 13212S001");
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < OceanLoading::kConstituents; ++column) {
      INFO(row << " " << column);
      CHECK(other.rows(row, column) == Approx(0.01 * (row + 1) + 1e-5 * (column + 1)));
      CHECK(other.rows(row + 3, column) == Approx(100.0 * (row + 1) + column + 1 + 0.1));
    }
  }
}

TEST_CASE("BLQ rows become metres and radians, by constituent", "[blq]") {
  const OceanLoading loading = ocean_loading(read_blq_text(kOther, "").rows);
  CHECK(loading.amplitude_m(0, OceanLoading::kM2) == Approx(0.01001));
  CHECK(loading.amplitude_m(1, OceanLoading::kS2) == Approx(0.02002));
  CHECK(loading.amplitude_m(2, OceanLoading::kSsa) == Approx(0.03011));
  CHECK(loading.phase(0, OceanLoading::kQ1) == Approx(108.1 * std::numbers::pi / 180.0));
  CHECK(loading.phase(2, OceanLoading::kM2) == Approx(301.1 * std::numbers::pi / 180.0));
}

TEST_CASE("a BLQ station is named in any case, whole or by its first word", "[blq]") {
  const std::string text = kBlqHeader + kOnsala + kOther;
  CHECK(read_blq_text(text, "onsala").name == "ONSALA");
  CHECK(read_blq_text(text, " 7840 ").name == "7840 13212S001");
  CHECK(read_blq_text(kOnsala, "").name == "ONSALA");
  CHECK(read_blq_text("\xef\xbb\xbf\r\n" + replaced(kOnsala, "\n", "\r\n"), "Onsala").line == 2);
  // A whole name goes before another's first word.
  const std::string marker = replaced(kOther, "7840 13212S001", "7840");
  CHECK(read_blq_text(kOther + marker, "7840").name == "7840");
  CHECK_THAT(error_of(kOther + replaced(kOther, "13212S001", "13212M009"), "7840"),
             Catch::Contains(":9: the name fits more than one station") &&
                 Catch::Contains("'7840 13212S001', '7840 13212M009'"));
  CHECK_THAT(error_of(text, ""), Catch::Contains("more than one station; name") &&
                                     Catch::Contains("'ONSALA', '7840 13212S001'"));
}

TEST_CASE("a BLQ station that is absent or there twice is an error that says so", "[blq]") {
  const std::string text = kBlqHeader + kOnsala + kOther;
  CHECK(error_of(text, "BRUX") ==
        ": station 'BRUX' is not in the file; there are 'ONSALA', '7840 13212S001'");
  CHECK_THAT(error_of(text, "onsela"), Catch::Contains("did you mean 'ONSALA'?"));
  CHECK(error_of(text + kOnsala, "ONSALA") ==
        ":23: station 'ONSALA' is there twice, first in line 7; remove one");
  std::string many;
  for (int i = 0; i < 50; ++i) many += replaced(kOnsala, "ONSALA", "S" + std::to_string(i));
  CHECK_THAT(error_of(many, "BRUX"), Catch::Contains("'S19' and 30 more"));
}

TEST_CASE("a damaged BLQ station is named with its line; others do not mind", "[blq]") {
  struct Case {
    std::string text, what;
  };
  const std::string row = "  .00144 .00035";
  const std::string seventh = kOnsala + "  .1 .1 .1 .1 .1 .1 .1 .1 .1 .1 .1\n";
  for (const auto& [text, what] :
       {Case{replaced(kOnsala, row, "  .00144"), ":10: station 'ONSALA': row has 10 columns"},
        Case{replaced(kOnsala, row, row + " .1"), ":10: station 'ONSALA': row has 12 columns"},
        Case{replaced(kOnsala, row, "  .00144 .0o035"),
             ":10: station 'ONSALA': '.0o035' is no num"},
        Case{replaced(kOnsala, row, "  .00144 nan"), ":10: station 'ONSALA': 'nan' is no number"},
        Case{replaced(kOnsala, row, "  .00144 -.0003"), ":10: station 'ONSALA': -.0003: no ampl"},
        Case{replaced(kOnsala, row, "  1.44 .00035"), ":10: station 'ONSALA': 1.44: no amplitude"},
        Case{replaced(kOnsala, "-177.7", "-999.9"), ":13: station 'ONSALA': -999.9: no phase"},
        Case{without_line(kOnsala, row), ":11: station 'ONSALA': -64.7: no amplitude"},
        Case{without_line(kOnsala, "   109.5"), ":14: station 'ONSALA': has 5 of its six rows"},
        Case{replaced(kOnsala, row, "  remark\n" + row), ":10: station 'ONSALA': has 1 of its six"},
        Case{seventh, ":15: station 'ONSALA': has more than six rows"}}) {
    INFO(text);
    CHECK_THAT(error_of(kBlqHeader + text + kOther, "ONSALA"), Catch::StartsWith(what));
    CHECK(read_blq_text(kBlqHeader + text + kOther, "7840").rows(5, 10) == 311.1);
    CHECK(read_blq_text(kBlqHeader + kOther + text, "7840").rows(0, 0) == 0.01001);
  }
}

TEST_CASE("a BLQ file cut off anywhere gives no wrong coefficients", "[blq]") {
  const std::string text = kBlqHeader + kOther + kOnsala;
  const BlqRows whole = read_blq_text(text, "ONSALA").rows;
  int refused = 0, read = 0, wrong = 0;
  for (std::size_t length = 0; length < text.size(); ++length) {
    const test::TemporaryFile file("cut.blq", text.substr(0, length));
    try {
      wrong += read_blq(file.path(), "ONSALA").rows == whole ? 0 : 1;
      ++read;
    } catch (const FileError&) {
      ++refused;
    }
  }
  CHECK(wrong == 0);
  CHECK(read == 1);  // without its last line feed
  CHECK(refused + 1 == static_cast<int>(text.size()));
}

TEST_CASE("what is no BLQ file is refused", "[blq]") {
  CHECK_THROWS_AS(read_blq("no/such.blq", "ONSALA"), FileError);
  for (const std::string& text :
       {std::string(), std::string("hello\n"), kBlqHeader, std::string("\x01\x02\n\x03\n")}) {
    CHECK_THAT(error_of(text, ""), Catch::Contains("holds no station"));
    CHECK_THAT(error_of(text, "ONSALA"), Catch::Contains("holds no station"));
  }
  const std::string swapped = replaced(kBlqHeader, "M2  S2", "S2  M2");
  CHECK_THAT(error_of(swapped + kOnsala, "ONSALA"),
             Catch::StartsWith(":3: columns are in another"));
  std::string prose;
  for (int i = 0; i < 20'001; ++i) prose += "x\n";
  CHECK_THAT(error_of(prose, "ONSALA"), Catch::StartsWith(":20001: more than 20000 stations"));
  // Gravity instead of displacement comes in nm/s^2.
  CHECK_THAT(error_of(replaced(kOnsala, ".00352", " 9.352"), ""), Catch::Contains("no amplitude"));
}

}  // namespace leonav
