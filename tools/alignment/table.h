// What many cold starts say together.
#pragma once
#include <iosfwd>
#include <span>

#include "tools/alignment/start.h"

namespace leonav {

// A row per way of starting. Returns the starts whose alignment was false or that were carried away
// later.
int print_table(std::span<const StartResult> results, std::ostream& out);

// A row per range of what starts were told wrongly, of those that drove for 15 s: whether that was
// found, and what was left of it at the end (more than ten degrees, or what is_off() calls so, is
// wrong). Returns those that were wrong at the end.
int print_told_table(std::span<const StartResult> results, std::ostream& out);

}  // namespace leonav
