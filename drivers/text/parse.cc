#include "drivers/text/parse.h"

#include <array>
#include <charconv>
#include <cmath>
#include <system_error>

namespace leonav {
namespace {

std::string locate(const std::string& file, long line, const std::string& message) {
  if (line <= 0) return file + ": " + message;
  return file + ":" + std::to_string(line) + ": " + message;
}

// Removes a leading plus, which std::from_chars refuses, unless another sign follows.
std::string_view without_plus(std::string_view text) {
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  return text;
}

}  // namespace

FileError::FileError(const std::string& file, long line, const std::string& message)
    : std::runtime_error(locate(file, line, message)) {}

std::string_view trim(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::string_view columns(std::string_view line, std::size_t first, std::size_t width) {
  return first < line.size() ? line.substr(first, width) : std::string_view();
}

std::optional<double> parse_double(std::string_view text) {
  text = without_plus(trim(text));
  std::array<char, 64> buffer;  // longer than any number a format defines
  if (text.empty() || text.size() > buffer.size()) return std::nullopt;
  for (std::size_t i = 0; i < text.size(); ++i) {
    buffer[i] = text[i] == 'D' || text[i] == 'd' ? 'E' : text[i];
  }
  double value = 0.0;
  const char* const end = buffer.data() + text.size();
  const auto [stop, error] = std::from_chars(buffer.data(), end, value);
  if (error != std::errc() || stop != end || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<int> parse_int(std::string_view text) {
  text = without_plus(trim(text));
  int value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || error != std::errc() || stop != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

void split_csv(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(trim(line.substr(0, comma)));
    if (comma == std::string_view::npos) return;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace leonav
