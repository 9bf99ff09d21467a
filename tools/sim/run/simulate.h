// A scenario from beginning to end.
#pragma once
#include <iosfwd>
#include <optional>
#include <string>

#include "tools/dataset/import_report.h"
#include "tools/sim/export/export.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Writes the log and the truth, and where asked the same run as files. Throws as LogOutput,
// write_truth_csv() and Export do.
ImportReport simulate(const Scenario& scenario, const std::string& log_path,
                      const std::string& truth_path, std::ostream* progress,
                      const std::optional<ExportOptions>& export_options = std::nullopt);

}  // namespace leonav::sim
