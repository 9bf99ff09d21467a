#include "daemon/journal/internal/journal_name.h"

#include <algorithm>
#include <array>
#include <bitset>
#include <cerrno>
#include <charconv>
#include <cstdio>

#include "drivers/lcm/piece_name.h"

namespace leonav {

std::optional<int> journal_number(std::string_view journal, std::string_view name) {
  if (!journal.starts_with(name)) return std::nullopt;
  journal.remove_prefix(name.size());
  if (journal.empty()) return 0;
  constexpr std::size_t kMostDigits = 4;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  if (journal.size() < 2 || journal.size() > 1 + kMostDigits || journal[0] != '.' ||
      journal[1] == '0' || !std::all_of(journal.begin() + 1, journal.end(), is_digit))
    return std::nullopt;
  int number = 0;
  std::from_chars(journal.data() + 1, journal.data() + journal.size(), number);
  return number;
}

bool format_journal_name(std::string_view name, int number, std::span<char> text) {
  char ending[16] = "";
  if (number > 0) std::snprintf(ending, sizeof ending, ".%d", number);
  const int length = std::snprintf(text.data(), text.size(), "%.*s%s",
                                   static_cast<int>(name.size()), name.data(), ending);
  return length > 0 && static_cast<std::size_t>(length) < text.size();
}

std::optional<int> claim_journal(std::string_view name, JournalFolder* folder, JournalFile* file,
                                 DiskCalls* disk, int most_numbers) {
  std::bitset<kMostNumberedJournals + 1> taken;
  folder->for_each_name([&](const char* entry) {
    if (const auto number = journal_number(parse_piece_name(entry).journal, name))
      taken.set(static_cast<std::size_t>(*number));
  });
  std::array<char, 256> text;
  for (int number = 0; number <= most_numbers; ++number) {
    if (taken.test(static_cast<std::size_t>(number))) continue;
    if (!format_journal_name(name, number, text)) {
      disk->set_error(ENAMETOOLONG);
      return std::nullopt;
    }
    // In one step, so that two daemons cannot both succeed.
    if (file->open(folder->descriptor(), text.data(), true)) return number;
    if (disk->error() != EEXIST) return std::nullopt;
  }
  disk->set_error(EEXIST);
  return std::nullopt;
}

}  // namespace leonav
