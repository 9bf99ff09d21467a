// These functions write to a descriptor whose reader may have stopped.
#pragma once
#include <string_view>

namespace leonav {

// Waits for as long as it takes. What the system refuses is dropped.
void write_whole(int descriptor, std::string_view text);

// Returns whether there is room, or comes within `longest_ms`; -1: however long it takes.
bool wait_for_room(int descriptor, int longest_ms);

// Waits for room for `longest_ms` at most at each part of the text, and returns whether all of it
// is written. May be called by the handler of a signal.
bool write_where_there_is_room(int descriptor, std::string_view text, int longest_ms);

}  // namespace leonav
