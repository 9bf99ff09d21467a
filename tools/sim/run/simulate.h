// A scenario from beginning to end.
#pragma once
#include <iosfwd>
#include <string>

#include "tools/dataset/import_report.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Writes the log and the truth. Throws as LogOutput and write_truth_csv() do.
ImportReport simulate(const Scenario& scenario, const std::string& log_path,
                      const std::string& truth_path, std::ostream* progress);

}  // namespace leonav::sim
