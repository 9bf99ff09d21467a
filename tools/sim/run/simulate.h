// This unit runs a scenario from beginning to end.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "tools/common/progress_bar.h"
#include "tools/import/import_report.h"
#include "tools/sim/export/export.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Names of the outputs.
struct RunOutputs {
  std::string log, truth;
  std::optional<ExportOptions> files;  // the same run as files, if requested
};

// Counts of a run.
struct RunReport {
  ImportReport written;
  std::array<FitStatistics, kSystemCount> fits;  // of broadcast issues to the true orbits
};
// Returns the report as text of several lines.
std::string to_string(const RunReport& report);

// Writes the log and the truth.
//
// Throws std::runtime_error if the scenario leaves nothing to write, and as LogOutput,
// write_truth_csv() and Export do; then no incomplete log or truth remains.
RunReport simulate(const Scenario& scenario, const RunOutputs& outputs, ProgressBar* progress);

}  // namespace leonav::sim
