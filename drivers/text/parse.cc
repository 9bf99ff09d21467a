#include "drivers/text/parse.h"

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <system_error>

namespace leonav {
namespace {

std::string locate(const std::string& file, long line, const std::string& message) {
  if (line <= 0) return file + ": " + message;
  return file + ":" + std::to_string(line) + ": " + message;
}

// A leading plus, which std::from_chars refuses, removed; not if another sign follows.
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

LineReader::LineReader(const std::string& path) : path_(path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    throw FileError(path, 0, "is a directory; give the file inside it");
  }
  errno = 0;
  stream_.open(path, std::ios::binary);
  if (!stream_) {
    const std::string reason = errno != 0 ? std::strerror(errno) : "unknown reason";
    throw FileError(path, 0,
                    "cannot be opened (" + reason + "); check the path and that it is readable");
  }
}

bool LineReader::next(std::string_view& line) {
  line_.clear();
  std::streambuf* const buffer = stream_.rdbuf();
  bool any = false;
  for (;;) {
    const int c = buffer->sbumpc();
    if (c == std::char_traits<char>::eof()) break;
    any = true;
    if (c == '\n') break;
    if (line_.size() >= kMaxLineLength) {
      ++line_number_;
      fail("line is longer than " + std::to_string(kMaxLineLength) +
           " characters; this is not a text file of the expected format");
    }
    line_.push_back(static_cast<char>(c));
  }
  if (!any) return false;
  ++line_number_;
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  line = line_;
  return true;
}

void LineReader::fail(const std::string& message) const {
  throw FileError(path_, line_number_, message);
}

}  // namespace leonav
