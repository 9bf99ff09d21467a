// The tables of a smoothed log: the grid of --rate, and residuals as numbers of the drive.
#include "tools/smooth/result_tables.h"

#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "core/base/square.h"
#include "drivers/csv/solution_csv.h"
#include "smooth_rig.h"
#include "support/temporary_file.h"
#include "tools/smooth/smooth_report.h"
#include "tools/smooth/trajectory.h"

namespace leonav::test {
namespace {

std::vector<std::vector<std::string>> table_of(const std::string& path) {
  std::vector<std::vector<std::string>> table;
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);) {
    table.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');) table.back().push_back(field);
  }
  return table;
}

std::vector<SolutionRow> rows_of(std::optional<double> rate_hz) {
  const SmoothedDrive& smoothed = smoothed_drive();
  const TemporaryFile place("unused", "");
  const std::string path = place.beside("solution.csv");
  const long rows = write_solution(path, smoothed.graph, smoothed.result, rate_hz);
  const SolutionCsv read = read_solution_csv(path);
  CHECK(static_cast<long>(read.rows.size()) == rows);
  return read.rows;
}

}  // namespace

TEST_CASE("without a rate a smoothed log has a row per epoch, at its time") {
  const LogGraph& graph = smoothed_drive().graph;
  const std::vector<SolutionRow> rows = rows_of(std::nullopt);
  REQUIRE(static_cast<int>(rows.size()) == graph.size());
  for (int k = 0; k < graph.size(); ++k) {
    const SolutionRow& row = rows[static_cast<std::size_t>(k)];
    CHECK(row.pva.time == graph.at(k).time);
    CHECK((to_ecef(row.pva.position) - graph.at(k).state.nav.p_e).norm() < 1e-3);
    CHECK(row.source == Source::kSmoother);
    CHECK(row.pva.yaw);
    CHECK(row.sigma_p_n);
  }
}

TEST_CASE("rows at a rate are the first samples on a grid of GPS time, each point once") {
  const double rate_hz = GENERATE(0.5, 10.0, 50.0, 1000.0);
  const SmoothedDrive& smoothed = smoothed_drive();
  const std::vector<SolutionRow> rows = rows_of(rate_hz);
  const double seconds = seconds_between(rows.back().pva.time, rows.front().pva.time);
  const auto interval_ns = static_cast<std::int64_t>(1e9 / rate_hz);
  const double imu_s = 1.0 / smoothed.drive.options.imu_rate_hz;
  CAPTURE(rate_hz, rows.size(), seconds);
  if (rate_hz < 100.0) {
    CHECK(static_cast<double>(rows.size()) == Approx(1.0 + seconds * rate_hz).margin(1.0));
    for (std::size_t i = 1; i < rows.size(); ++i) {
      const std::int64_t now = rows[i].pva.time.nanoseconds() / interval_ns;
      REQUIRE(now == rows[i - 1].pva.time.nanoseconds() / interval_ns + 1);
      const double late_s =
          1e-9 * static_cast<double>(rows[i].pva.time.nanoseconds() - now * interval_ns);
      REQUIRE(late_s < imu_s);
    }
  } else {  // more than there are samples: all of them, and the epochs beside
    CHECK(static_cast<double>(rows.size()) > seconds / imu_s);
  }
  double most = 0.0;
  for (const SolutionRow& row : rows)
    most = std::max(most,
                    (to_ecef(row.pva.position) - smoothed.drive.truth_at(row.pva.time).p_e).norm());
  CHECK(most < 1.0);
}

TEST_CASE("the forward table has the rows of the epochs, and wider sigmas") {
  const SmoothedDrive& smoothed = smoothed_drive();
  const TemporaryFile place("unused", "");
  const std::string path = place.beside("forward.csv");
  write_forward(path, smoothed.graph, smoothed.result);
  const SolutionCsv forward = read_solution_csv(path);
  const std::vector<SolutionRow> rows = rows_of(std::nullopt);
  REQUIRE(forward.rows.size() == rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    CHECK(forward.rows[i].pva.time == rows[i].pva.time);
    CHECK(forward.rows[i].sigma_p_n->norm() > rows[i].sigma_p_n->norm() - 2e-4);  // their digits
  }
}

// Codes of the drive have 0.5 m, carriers 3 mm; the combination free of the ionosphere multiplies
// that by 2.6 to 3. What a carrier's random walk takes up is not in its residual.
TEST_CASE("residuals are those of the drive's noise, one row per measurement") {
  const SmoothedDrive& smoothed = smoothed_drive();
  const TemporaryFile place("unused", "");
  const std::string path = place.beside("residuals.csv");
  write_residuals(path, smoothed.graph);
  const auto table = table_of(path);
  const std::vector<std::string> header = {
      "gps_week", "gps_tow_s", "satellite",  "observable",    "signals",
      "residual", "sigma",     "test_ratio", "weight_factor", "elevation_deg"};
  REQUIRE(table.front() == header);
  std::size_t measurements = 0;
  for (int k = 0; k < smoothed.graph.size(); ++k)
    measurements += smoothed.graph.at(k).measurements.size();
  REQUIRE(table.size() == measurements + 1);
  std::map<std::string, std::pair<double, int>> squares;
  for (std::size_t i = 1; i < table.size(); ++i) {
    const auto& row = table[i];
    REQUIRE(row.size() == header.size());
    const double residual = std::stod(row[5]), sigma = std::stod(row[6]), ratio = std::stod(row[7]),
                 factor = std::stod(row[8]), elevation = std::stod(row[9]);
    CHECK(ratio == Approx(std::abs(residual) / sigma).epsilon(0.02).margin(0.02));
    CHECK((factor >= 0.0 && factor <= 1.0));
    CHECK((elevation > 5.0 && elevation <= 90.0));
    CHECK((row[2][0] == 'G' || row[2][0] == 'E'));
    if (factor < 1.0) continue;
    squares[row[3]].first += square(residual);
    squares[row[3]].second += 1;
  }
  REQUIRE(squares.size() == 3);
  const auto rms = [&](const std::string& observable) {
    return std::sqrt(squares[observable].first / squares[observable].second);
  };
  WARN("rms of residuals: codes " << rms("code") << " m, carriers " << rms("carrier")
                                  << " m, Dopplers " << rms("doppler") << " m/s");
  CHECK(rms("code") > 2.4 * 0.5);
  CHECK(rms("code") < 3.0 * 0.5);
  CHECK(rms("carrier") > 0.002);
  CHECK(rms("carrier") < 3.0 * 0.003);
  CHECK(rms("doppler") == Approx(0.05).epsilon(0.2));
}

TEST_CASE("the report counts what was smoothed, and warns of what a user must know") {
  const SmoothedDrive& smoothed = smoothed_drive();
  std::ostringstream text;
  print_smoothed(smoothed.graph, smoothed.result, text);
  const std::string epochs = "epochs: " + std::to_string(smoothed.graph.size()) + " over ";
  for (const std::string& line : {epochs, std::string("segments: 1\n"),
                                  std::string("converged: yes"), std::string("gaps joined: 0\n")}) {
    CAPTURE(line, text.str());
    CHECK(text.str().find(line) != std::string::npos);
  }
  CHECK(smoothing_warnings(smoothed.graph, smoothed.result).empty());

  LogGraph parted = smoothed.graph;
  parted.at(20).process.exists = false;
  for (int k = 0; k < parted.size(); ++k)
    for (LogMeasurement& measurement : parted.at(k).measurements)
      measurement.residual = 2.0 * std::sqrt(measurement.variance);
  BatchResult result = smoothed.result;
  result.converged = false;
  const std::vector<std::string> warnings = smoothing_warnings(parted, result);
  REQUIRE(warnings.size() == 4);
  CHECK_THAT(warnings[0], Catch::Contains("not converged"));
  CHECK_THAT(warnings[1], Catch::Contains("codes do not fit their sigmas"));
  CHECK_THAT(warnings[2], Catch::Contains("carriers do not fit their sigmas"));
  CHECK_THAT(warnings[3], Catch::Contains("2 parts"));

  result.extension_left_out = true;
  CHECK_THAT(smoothing_warnings(parted, result)[3], Catch::Contains("--iterations 3 or more"));
}

}  // namespace leonav::test
