// This unit writes a CSV row per cold start.
#pragma once
#include <iosfwd>
#include <span>

#include "tools/starts/cold_start.h"

namespace leonav {

void write_start_list(std::span<const StartResult> results, std::ostream& out);

}  // namespace leonav
