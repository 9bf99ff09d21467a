// PieceName is the name of a file that holds a piece of a journal.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace leonav {

// The first piece has the journal's own name, the next ones NAME.part0002, NAME.part0003, ...;
// behind either may stand ".kept".
struct PieceName {
  std::string_view journal;  // name of the first piece
  std::int64_t number = 1;
  bool kept = false;
};

// Takes a name apart. Every name is one: what is no ending belongs to the journal's name.
PieceName parse_piece_name(std::string_view name);

// Writes a name, with a final zero; false: it does not fit.
bool format_piece_name(const PieceName& name, std::span<char> text);

}  // namespace leonav
