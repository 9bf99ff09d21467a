// A scenario from beginning to end.
#pragma once
#include <array>
#include <optional>
#include <string>

#include "tools/common/progress_bar.h"
#include "tools/dataset/import_report.h"
#include "tools/sim/export/export.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

struct RunOutputs {
  std::string log, truth;
  std::optional<ExportOptions> files;  // the same run as files, where asked for
};

struct RunReport {
  ImportReport written;
  std::array<FitStatistics, kSystemCount> fits;  // of broadcast issues to the true orbits
};
// As text of several lines.
std::string to_string(const RunReport& report);

// Writes the log and the truth. Throws std::runtime_error where the scenario leaves nothing to
// write, and as LogOutput, write_truth_csv() and Export do; no half-written log or truth stays
// behind.
RunReport simulate(const Scenario& scenario, const RunOutputs& outputs, ProgressBar* progress);

}  // namespace leonav::sim
