#include "tools/evaluate/integrity_mode.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <stdexcept>

#include "drivers/csv/csv_writer.h"
#include "drivers/text/parse.h"
#include "tools/evaluate/integrity.h"
#include "tools/evaluate/internal/plot_script.h"

namespace leonav {
namespace {

namespace fs = std::filesystem;

constexpr const char* kTableHeader =
    "gps_week,gps_tow_s,error_horizontal_m,protection_horizontal_m,error_vertical_m,"
    "protection_vertical_m";

std::vector<double> alert_limits(const std::string& words) {
  std::vector<double> limits;
  for (std::size_t begin = 0; begin <= words.size();) {
    const std::size_t end = std::min(words.find(',', begin), words.size());
    const auto limit = parse_double(words.substr(begin, end - begin));
    if (!limit || !(*limit > 0.0))
      throw UsageError("--alert-limit-m: '" + words + "' is no list of positive numbers");
    limits.push_back(*limit);
    begin = end + 1;
  }
  return limits;
}

IntegrityOptions options_of(const Arguments& arguments) {
  IntegrityOptions options;
  options.alert_limits_m = alert_limits(arguments.get("--alert-limit-m"));
  options.block_s = arguments.number("--block-s");
  if (!(options.block_s >= 0.001 && options.block_s <= 1e6))
    throw UsageError("--block-s must be 0.001 to 1000000");
  return options;
}

std::vector<IntegrityEvaluation> evaluate_all(const std::vector<Evaluation>& runs,
                                              const IntegrityOptions& options) {
  std::vector<IntegrityEvaluation> evaluations;
  for (const Evaluation& run : runs)
    evaluations.push_back(evaluate_integrity(run.label, run.comparison, options));
  if (evaluations.size() < 2) return evaluations;
  IntegrityEvaluation sum = evaluations.front();
  sum.label = "all runs";
  for (std::size_t i = 1; i < evaluations.size(); ++i) add_counts(evaluations[i], &sum);
  evaluations.push_back(sum);
  return evaluations;
}

// Writes the errors and levels of all runs, which the diagrams are drawn from.
void write_table(const std::vector<Evaluation>& runs, const fs::path& folder) {
  CsvWriter writer((folder / "integrity.csv").string(), kTableHeader);
  for (const Evaluation& run : runs)
    for (const ErrorSample& sample : run.comparison.errors)
      writer.time(sample.time)
          .number(sample.horizontal(), 4)
          .number(sample.levels.horizontal_m, 4)
          .number(std::abs(sample.neu.z()), 4)
          .number(sample.levels.vertical_m, 4)
          .end_row();
  writer.close();
}

}  // namespace

int run_integrity(const Arguments& arguments, const std::vector<Evaluation>& runs) {
  const IntegrityOptions options = options_of(arguments);
  const std::vector<IntegrityEvaluation> evaluations = evaluate_all(runs, options);
  std::cout << to_table(evaluations, options);
  if (arguments.has("--json")) {
    std::ofstream file(arguments.get("--json"));
    file << to_json(evaluations, options);
    if (!file.flush()) throw std::runtime_error(arguments.get("--json") + ": cannot be written");
  }
  if (!arguments.has("--plots")) return 0;
  const fs::path folder = make_plot_folder(arguments.get("--plots"));
  write_table(runs, folder);
  run_plot_script("leonav-integrity-plots",
                  {"--alert-limit-m", arguments.get("--alert-limit-m"), folder.string()}, folder);
  return 0;
}

}  // namespace leonav
