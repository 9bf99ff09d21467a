// journal_pieces() finds the files that belong to one log: the pieces of a journal, in order.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "drivers/lcm/journal_marks.h"

namespace leonav {

// The files of a log, in the order of reading.
struct LogFiles {
  std::vector<std::string> paths;        // never empty
  std::optional<PieceInfo> first_piece;  // of the first file; nullopt: the log has no pieces
};

// `path` is
// - a folder: all pieces in it, which must be of one run; other files are passed over;
// - a piece of a journal, or its name before it was kept: that one and the later ones of the run
//   beside it;
// - any other log: that file alone.
// Throws EventLogError where a folder holds no piece, or those of several runs.
LogFiles journal_pieces(const std::string& path);

}  // namespace leonav
