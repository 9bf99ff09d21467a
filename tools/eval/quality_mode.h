// leonav-eval --quality: how good the measurements of a log are.
#pragma once
#include "tools/common/arguments.h"

namespace leonav {

// Prints the table, and writes JSON and plots where asked. Throws as analyse_quality() and
// UsageError.
int run_quality(const Arguments& arguments);

}  // namespace leonav
