#include "drivers/lcm/piece_name.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace leonav {
namespace {

constexpr std::string_view kKept = ".kept", kPart = ".part";
constexpr std::size_t kFewestDigits = 4, kMostDigits = 9;

bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace

PieceName parse_piece_name(std::string_view name) {
  PieceName piece{name};
  if (name.size() > kKept.size() && name.ends_with(kKept)) {
    piece.kept = true;
    name.remove_suffix(kKept.size());
    piece.journal = name;
  }
  const std::size_t part = name.rfind(kPart);
  if (part == std::string_view::npos || part == 0) return piece;
  const std::string_view digits = name.substr(part + kPart.size());
  if (digits.size() < kFewestDigits || digits.size() > kMostDigits ||
      !std::all_of(digits.begin(), digits.end(), is_digit))
    return piece;
  std::int64_t number = 0;
  std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (number < 2) return piece;
  piece.journal = name.substr(0, part);
  piece.number = number;
  return piece;
}

bool format_piece_name(const PieceName& name, std::span<char> text) {
  char part[32] = "";
  if (name.number > 1)
    std::snprintf(part, sizeof part, ".part%04lld", static_cast<long long>(name.number));
  const int length =
      std::snprintf(text.data(), text.size(), "%.*s%s%s", static_cast<int>(name.journal.size()),
                    name.journal.data(), part, name.kept ? kKept.data() : "");
  return length > 0 && static_cast<std::size_t>(length) < text.size();
}

}  // namespace leonav
