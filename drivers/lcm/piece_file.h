// These functions look at the ends of a file that may be a piece of a journal.
#pragma once
#include <optional>
#include <string_view>

#include "drivers/lcm/journal_marks.h"

namespace leonav {

// Returns the mark at the beginning of a piece; nullopt: the file is none, as journals of older
// versions are none. `descriptor`: open for reading. Does not allocate.
std::optional<PieceInfo> read_piece_info(int descriptor);

// The same for the file of this name in a folder. Only a regular file is opened.
std::optional<PieceInfo> read_piece_info(int folder, const char* name);

// Returns whether the last event of a log is the end mark, as where a run was stopped cleanly.
bool has_end_mark(int folder, const char* name);

}  // namespace leonav
