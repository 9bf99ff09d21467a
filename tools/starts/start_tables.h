// This unit prints the summary tables of many cold starts.
#pragma once
#include <iosfwd>
#include <span>

#include "tools/starts/cold_start.h"

namespace leonav {

// Prints a row per kind of motion. Returns the number of starts whose alignment was false or that
// diverged later.
int print_table(std::span<const StartResult> results, std::ostream& out);

// Prints a row per range of the given heading's error, for starts that drove for 15 s.
//
// The row states whether the error was found, and what was left at the end (more than ten degrees,
// or is_off(), is wrong). Returns the number of those that were wrong at the end.
int print_given_heading_table(std::span<const StartResult> results, std::ostream& out);

}  // namespace leonav
