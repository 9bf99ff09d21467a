// What many cold starts say together.
#pragma once
#include <iosfwd>
#include <span>

#include "start.h"

namespace leonav {

// A heading that is neither within 5 degrees nor within five of the sigmas it was told with.
bool is_false(const StartResult& result);

// A row per way of starting. Returns the false alignments.
int print_table(std::span<const StartResult> results, std::ostream& out);

// A row per range of what starts were told wrongly, of those that drove for 15 s: whether that was
// found, and what was left of it at the end (more than ten degrees, or what is_false() calls so, is
// wrong). Returns those that were wrong at the end.
int print_told_table(std::span<const StartResult> results, std::ostream& out);

}  // namespace leonav
