#include "daemon/journal/internal/journal_path.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <set>

#include "drivers/lcm/event_log.h"
#include "drivers/lcm/piece_name.h"

namespace leonav {
namespace {

namespace fs = std::filesystem;

// False if something of that name exists; in one step, so that two daemons cannot both succeed.
bool create_new(const std::string& path) {
  const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (descriptor < 0) return errno != EEXIST;
  close(descriptor);
  return true;
}

// The names of the journals that have later pieces, or kept ones, in the folder of `path`.
std::set<std::string> journals_with_pieces(const fs::path& path) {
  std::set<std::string> names;
  std::error_code error;
  fs::directory_iterator entry(path.has_parent_path() ? path.parent_path() : ".", error);
  for (const fs::directory_iterator end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename();
    const PieceName piece = parse_piece_name(name);
    if (piece.number > 1 || piece.kept) names.emplace(piece.journal);
  }
  return names;
}

}  // namespace

std::string claim_journal_path(const std::string& path, int most_numbers) {
  const std::set<std::string> taken = journals_with_pieces(path);
  const auto claim = [&](const std::string& name) {
    return taken.count(fs::path(name).filename()) == 0 && create_new(name);
  };
  std::error_code error;
  if (claim(path)) return path;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error)) return path;
  for (int number = 1; number <= most_numbers; ++number) {
    const std::string numbered = path + "." + std::to_string(number);
    if (claim(numbered)) return numbered;
  }
  throw EventLogError(path + ": exists, and so do .1 to ." + std::to_string(most_numbers) +
                      "; move the journals away");
}

}  // namespace leonav
