#include "tools/evaluate/internal/residuals.h"

#include "drivers/text/parse.h"
#include "support/catch.h"
#include "support/temporary_file.h"

using namespace leonav;

namespace {
const std::string kColumns =
    "gps_week,gps_tow_s,satellite,observable,signals,observation,innovation,innovation_sigma,"
    "test_ratio,weight_factor,reason,residual,elevation_deg\n";
std::string row(const std::string& satellite, const std::string& observable,
                const std::string& reason, const std::string& residual,
                const std::string& elevation) {
  return "2111,345600.000," + satellite + "," + observable + ",1C+2W,1,1,1,1,1," + reason + "," +
         residual + "," + elevation + "\n";
}
}  // namespace

TEST_CASE("residuals are those of measurements that counted, by system, observable, elevation") {
  const test::TemporaryFile file(
      "measurements.csv",
      kColumns + row("G05", "carrier", "used", "0.003", "80") +
          row("G07", "carrier", "downweighted", "-0.004", "20") +
          row("G08", "carrier", "used", "0.02", "15") +
          row("G08", "carrier", "outlier", "5.0", "50") + row("G05", "code", "used", "0.5", "80") +
          row("E05", "carrier", "used", "x", "80") + row("E06", "carrier", "used", "0.001", "61"));
  const std::vector<ResidualRow> rows = read_residuals(file.path());
  REQUIRE(rows.size() == 3);
  CHECK(rows[0].system == "gps");
  CHECK(rows[0].observable == "carrier");
  CHECK(rows[0].high.count == 2);
  CHECK(rows[0].high.rms == Approx(0.005 / std::sqrt(2.0)));
  CHECK(rows[0].high.mean == Approx(-0.0005));
  CHECK(rows[0].bins[1].count == 1);
  CHECK(rows[0].bins[1].mean == Approx(0.02));
  CHECK(rows[0].bins[5].count == 1);
  CHECK(rows[1].observable == "code");
  CHECK(rows[2].system == "galileo");
  CHECK(rows[2].high.count == 1);
  CHECK(to_table(rows).find("galileo") != std::string::npos);
}

TEST_CASE("a file without residuals that counted is an error, as is another file") {
  const test::TemporaryFile none("measurements.csv",
                                 kColumns + row("G05", "code", "outlier", "1", "20"));
  CHECK_THROWS_AS(read_residuals(none.path()), FileError);
  const test::TemporaryFile other("solution.csv", "gps_week,gps_tow_s\n1,2\n");
  CHECK_THROWS_AS(read_residuals(other.path()), FileError);
}
