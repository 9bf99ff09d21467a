// A row per cold start, as CSV.
#pragma once
#include <iosfwd>
#include <span>

#include "tools/alignment/start.h"

namespace leonav {

void write_start_list(std::span<const StartResult> results, std::ostream& out);

}  // namespace leonav
