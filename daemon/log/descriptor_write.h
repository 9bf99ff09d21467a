// These functions write to a descriptor whose reader may have stopped.
#pragma once
#include <string_view>

namespace leonav {

// Returns whether there is room, or comes within `longest_ms`; -1: however long it takes.
bool wait_for_room(int descriptor, int longest_ms);

// These two return what is not written: what is left where the system refuses to write on, as on a
// full disk, or where there is no room in time; empty: all is written.

// Waits for as long as it takes.
std::string_view write_whole(int descriptor, std::string_view text);

// Waits for room for `longest_ms` at most at each part of the text. May be called by the handler of
// a signal.
std::string_view write_where_there_is_room(int descriptor, std::string_view text, int longest_ms);

}  // namespace leonav
