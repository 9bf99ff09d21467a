#include "drivers/lcm/journal_pieces.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>

#include "drivers/lcm/event_log.h"
#include "drivers/lcm/piece_file.h"
#include "drivers/lcm/piece_name.h"

namespace leonav {
namespace {

namespace fs = std::filesystem;

struct Piece {
  std::string path;
  PieceInfo info;
};

std::optional<PieceInfo> info_of(const std::string& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return std::nullopt;
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return std::nullopt;
  const auto info = read_piece_info(descriptor);
  close(descriptor);
  return info;
}

// The pieces in a folder whose journal has this name; empty: any name.
std::vector<Piece> pieces_in(const fs::path& folder, std::string_view journal) {
  std::vector<Piece> pieces;
  std::error_code error;
  fs::directory_iterator entry(folder, error);
  for (const fs::directory_iterator end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename();
    if (!journal.empty() && parse_piece_name(name).journal != journal) continue;
    if (const auto info = info_of(entry->path())) pieces.push_back({entry->path(), *info});
  }
  if (error) throw EventLogError(folder.string() + ": cannot be read: " + error.message());
  std::sort(pieces.begin(), pieces.end(), [](const Piece& a, const Piece& b) {
    return std::pair(a.info.number, a.path) < std::pair(b.info.number, b.path);
  });
  return pieces;
}

void require_one_run(const std::string& folder, const std::vector<Piece>& pieces) {
  if (pieces.empty()) {
    throw EventLogError(folder +
                        ": is a directory without a piece of a journal; name the log itself");
  }
  for (const Piece& piece : pieces) {
    if (piece.info.run == pieces.front().info.run) continue;
    throw EventLogError(folder + ": holds journals of several runs, such as " +
                        pieces.front().path + " and " + piece.path +
                        "; name the first piece of one of them");
  }
}

void require_each_once(const std::vector<Piece>& pieces) {
  const auto same = std::adjacent_find(
      pieces.begin(), pieces.end(),
      [](const Piece& a, const Piece& b) { return a.info.number == b.info.number; });
  if (same == pieces.end()) return;
  throw EventLogError(same->path + ": is the same piece of a journal as " + (same + 1)->path +
                      "; move one of them away");
}

LogFiles files_of(const std::vector<Piece>& pieces) {
  LogFiles files;
  for (const Piece& piece : pieces) files.paths.push_back(piece.path);
  files.first_piece = pieces.front().info;
  return files;
}

}  // namespace

LogFiles journal_pieces(const std::string& given) {
  std::error_code error;
  // A piece that is kept after a fault has another name than its run was given.
  const bool renamed = !fs::exists(given, error) && fs::exists(given + ".kept", error);
  const std::string path = renamed ? given + ".kept" : given;
  if (fs::is_directory(path, error)) {
    const std::vector<Piece> pieces = pieces_in(path, "");
    require_one_run(path, pieces);
    require_each_once(pieces);
    return files_of(pieces);
  }
  const auto info = info_of(path);
  if (!info) return {{path}, std::nullopt};
  const fs::path file(path);
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const std::string name = file.filename();
  std::vector<Piece> pieces = pieces_in(folder, parse_piece_name(name).journal);
  std::erase_if(pieces, [&](const Piece& one) {
    return one.info.run != info->run || one.info.number <= info->number;
  });
  pieces.insert(pieces.begin(), Piece{path, *info});
  require_each_once(pieces);
  return files_of(pieces);
}

}  // namespace leonav
