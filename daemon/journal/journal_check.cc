#include "daemon/journal/journal_check.h"

#include <climits>
#include <filesystem>
#include <string>
#include <string_view>

#include "daemon/config/load_config.h"
#include "drivers/lcm/piece_name.h"

namespace leonav {
namespace {

// The longest that may stand behind journal.path (journal_name.h, piece_name.h).
constexpr std::size_t kLongestEnding = std::string_view(".9999.part999999999.kept").size();
constexpr double kShortestPiece_s = 10.0;

// Adds what is wrong with a key as a line of its own.
void add(const DaemonConfig& config, const std::string& key, const std::string& why,
         std::string* wrong) {
  *wrong += (wrong->empty() ? "" : "\n") + config.source.place_of(key) + ": " + why;
}

// Returns why the path cannot be a journal's; "": it can.
std::string why_no_path(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename();
  const PieceName piece = parse_piece_name(name);
  if (piece.kept || piece.number > 1) {
    return "'" + name + "' is the name of a later or a kept piece of '" +
           std::string(piece.journal) + "'; give a name that does not end in " +
           (piece.kept ? ".kept" : ".part and digits");
  }
  const bool is_name = name.size() + kLongestEnding > NAME_MAX;
  if (!is_name && path.size() + kLongestEnding < PATH_MAX) return "";
  const std::size_t most = is_name ? NAME_MAX : PATH_MAX - 1;
  // Appended, because gcc 12 reports a false error in a sum of these.
  std::string why = is_name ? "the name" : "the path";
  why += " is too long, because its pieces have up to ";
  why += std::to_string(kLongestEnding);
  why += " characters more; at most ";
  why += std::to_string(most - kLongestEnding);
  why += " characters are possible, these are ";
  why += std::to_string(is_name ? name.size() : path.size());
  return why;
}

}  // namespace

void require_journal(const DaemonConfig& config) {
  if (config.journal.path.empty()) return;
  std::string wrong;
  const std::string no_path = why_no_path(config.journal.path);
  if (!no_path.empty()) add(config, "journal.path", no_path, &wrong);
  if (config.journal.piece_s > 0.0 && config.journal.piece_s < kShortestPiece_s)
    add(config, "journal.piece_s", "must be at least 10, or 0 for pieces of any age", &wrong);
  if (!wrong.empty()) throw ConfigError(wrong);
}

}  // namespace leonav
