// This unit implements leonav-eval --integrity, which holds errors against protection levels.
#pragma once
#include <vector>

#include "tools/common/arguments.h"
#include "tools/evaluate/statistics.h"

namespace leonav {

// Prints the counts of each run, and their sum where there are several; writes JSON and Stanford
// diagrams if requested. Throws UsageError and std::runtime_error.
int run_integrity(const Arguments& arguments, const std::vector<Evaluation>& runs);

}  // namespace leonav
