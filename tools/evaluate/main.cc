// leonav-eval computes the errors of one or several runs against a truth; with --quality it
// measures the quality of a log's measurements.
#include <fstream>
#include <iostream>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

#include "drivers/csv/imu_csv.h"
#include "drivers/csv/truth_csv.h"
#include "tools/common/arguments.h"
#include "tools/evaluate/integrity_mode.h"
#include "tools/evaluate/internal/gyro_heading.h"
#include "tools/evaluate/internal/residuals.h"
#include "tools/evaluate/quality_mode.h"
#include "tools/evaluate/statistics.h"

namespace {

using leonav::Arguments;

int body(int argc, char** argv) {
  Arguments arguments(
      "leonav-eval",
      "--truth truth.csv|--truth-point LAT,LON,H [options] [LABEL=]solution.csv ...\n"
      "       leonav-eval --integrity --truth truth.csv [--alert-limit-m 1,3,10] [--json FILE] "
      "[--plots DIR]\n"
      "               [LABEL=]solution.csv ...\n"
      "       leonav-eval --residuals measurements.csv\n"
      "       leonav-eval --quality [--json FILE] [--plots DIR] run.lcmlog",
      "Compares solutions (solution.csv of leonav-replay, or RTKLIB .pos files) with a truth:\n"
      "RMSE, mean, percentiles per component, availability, convergence, attitude.\n"
      "With --integrity: how often the errors exceed the protection levels and alert limits, how "
      "often\n"
      "the levels are within the limits; of all runs together too.\n"
      "With --residuals: what the estimator left of its measurements, by system and elevation.\n"
      "With --quality: how good the GNSS measurements of a log or journal are, without a truth:\n"
      "satellites, dilution of precision, code multipath, C/N0, cycle slips.\n"
      "truth.csv has the columns " +
          std::string(leonav::kTruthCsvHeader) +
          ",\nof which the first five are needed; leonav-replay --columns prints those of its "
          "tables.");
  arguments.option("--truth", "FILE", "truth.csv or an RTKLIB .pos file to judge by")
      .option("--truth-point", "LAT,LON,H",
              "in place of --truth: a surveyed point that did not move, degrees and metres above "
              "the ellipsoid")
      .option("--json", "FILE",
              "write the numbers as JSON too, with the CDF; with --integrity: with histograms")
      .option("--convergence-bound", "M",
              "3D error that counts as converged when ten epochs in a row stay below", "3")
      .flag("--remove-offset",
            "remove the mean north, east, up error first (truth of unknown datum)")
      .option("--max-truth-gap", "S", "do not interpolate the truth over wider holes", "2")
      .option("--course-speed", "M_S",
              "where the truth has no yaw: its course counts as yaw above this speed", "0.7")
      .option("--max-course-rate", "DEG_S",
              "also judge yaw against course only where the course turns slower (mean over 2 s)")
      .option("--imu", "FILE",
              "imu.csv: also print how its gyros alone, fitted to the truth, follow the course: "
              "what an estimator can hope for")
      .option("--up-offset", "M", "added to the truth's height before comparing", "0")
      .option("--from", "TIME", "judge from this GPS time on: WEEK:SECONDS or YYYY-MM-DDThh:mm:ss")
      .option("--to", "TIME", "judge up to this GPS time")
      .option("--residuals", "FILE", "measurements.csv of leonav-replay; needs no truth")
      .flag("--quality", "judge the measurements of an LCM log instead of solutions")
      .option("--plots", "DIR",
              "with --quality: PNG plots, index.html and the tables behind them; with --integrity: "
              "Stanford diagrams and their table")
      .flag("--integrity", "hold the errors against the protection levels of solution.csv")
      .option("--alert-limit-m", "M,M,...", "with --integrity: alert limits", "1,3,10")
      .option("--block-s", "S",
              "with --integrity: epochs closer together than this count as one trial", "60")
      .option("--mask", "DEG", "with --quality: elevation from which a satellite is usable", "15")
      .option("--leo-bands", "BAND=MHZ,...",
              "with --quality: carriers of LEO satellites beside or in place of 1=1575.42,2=1227.6")
      .option("--prefix", "PREFIX", "with --quality: of the log's channels", "LEONAV_");
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.has("--quality")) return leonav::run_quality(arguments);
  const bool integrity = arguments.has("--integrity");
  for (const char* name : {"--plots", "--mask", "--leo-bands", "--prefix"}) {
    if (integrity && name == std::string("--plots")) continue;
    if (arguments.has(name)) throw leonav::UsageError(std::string(name) + " needs --quality");
  }
  for (const char* name : {"--alert-limit-m", "--block-s"}) {
    if (arguments.has(name) && !integrity)
      throw leonav::UsageError(std::string(name) + " needs --integrity");
  }
  if (arguments.has("--residuals")) {
    std::cout << leonav::to_table(leonav::read_residuals(arguments.get("--residuals")));
    if (arguments.positional().empty() && !arguments.has("--truth")) return 0;
  }
  if (arguments.positional().empty()) throw leonav::UsageError("no solution given (--help)");

  leonav::ErrorOptions options;
  options.max_truth_gap_s = arguments.number("--max-truth-gap");
  options.remove_offset = arguments.has("--remove-offset");
  options.course_speed_m_s = arguments.number("--course-speed");
  options.antenna_offset_up_m = arguments.number("--up-offset");
  if (arguments.has("--max-course-rate")) {
    options.max_course_rate = arguments.number("--max-course-rate") * std::numbers::pi / 180.0;
  }
  if (arguments.has("--from")) options.from = arguments.time("--from");
  if (arguments.has("--to")) options.to = arguments.time("--to");

  leonav::SkippedRows skipped;
  std::optional<leonav::TrackPoint> point;
  leonav::Track truth;
  if (arguments.has("--truth-point")) {
    for (const char* other : {"--truth", "--imu"}) {
      if (arguments.has(other))
        throw leonav::UsageError(std::string(other) + " does not go with --truth-point");
    }
    point = leonav::surveyed_point(arguments.get("--truth-point"));
    options.max_truth_gap_s = std::numeric_limits<double>::infinity();
  } else {
    truth = leonav::load_truth(arguments.required("--truth"), &skipped);
    std::cout << leonav::to_string(skipped);
  }
  std::vector<leonav::Evaluation> evaluations;
  for (const std::string& word : arguments.positional()) {
    const std::size_t equals = word.find('=');
    const std::string path = equals == std::string::npos ? word : word.substr(equals + 1);
    const std::string label = equals == std::string::npos ? word : word.substr(0, equals);
    leonav::SkippedRows of_solution;
    const leonav::Track solution = leonav::load_solution(path, &of_solution);
    if (point) truth = leonav::standing_at(*point, solution);
    evaluations.push_back(
        leonav::evaluate(label, solution, truth, options, arguments.number("--convergence-bound")));
    evaluations.back().skipped = of_solution;
  }
  if (integrity) return leonav::run_integrity(arguments, evaluations);
  std::cout << leonav::to_table(evaluations);
  if (arguments.has("--imu")) {
    const leonav::ImuCsv imu = leonav::read_imu_csv(arguments.get("--imu"));
    const auto& problems = imu.report.problems;
    std::cout << leonav::to_string(leonav::SkippedRows{imu.report.skipped, imu.report.rows,
                                                       problems.empty() ? "" : problems.front()});
    std::cout << leonav::to_table(leonav::evaluate_gyro_heading(imu.samples, truth, options));
  }
  if (arguments.has("--json")) {
    std::ofstream file(arguments.get("--json"));
    file << leonav::to_json(evaluations);
    if (!file.flush()) throw std::runtime_error(arguments.get("--json") + ": cannot be written");
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return leonav::run_tool("leonav-eval", body, argc, argv); }
