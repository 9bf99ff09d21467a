// This unit implements leonav-eval --quality, which measures the quality of a log's measurements.
#pragma once
#include "tools/common/arguments.h"

namespace leonav {

// Prints the table, and writes JSON and plots if requested. Throws UsageError, and the exceptions
// of analyse_quality().
int run_quality(const Arguments& arguments);

}  // namespace leonav
