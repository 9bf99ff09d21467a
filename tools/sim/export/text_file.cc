#include "tools/sim/export/text_file.h"

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>

#include "drivers/text/parse.h"

namespace leonav::sim {

std::string formatted(const char* format, ...) {
  std::array<char, 256> buffer;
  std::va_list arguments;
  va_start(arguments, format);
  const int length = std::vsnprintf(buffer.data(), buffer.size(), format, arguments);
  va_end(arguments);
  return std::string(buffer.data(), length < 0 ? 0 : std::min<std::size_t>(length, 255));
}

CalendarTime rounded_calendar(GpsTime time, int decimals) {
  std::int64_t unit = kNanosecondsPerSecond;
  for (int i = 0; i < decimals; ++i) unit /= 10;
  const std::int64_t rounded = (time.nanoseconds() + unit / 2) / unit * unit;
  return to_calendar(GpsTime::from_nanoseconds(rounded));
}

TextFile::TextFile(const std::string& path)
    : path_(path), stream_(path, std::ios::binary | std::ios::trunc) {
  if (!stream_) {
    throw FileError(path, 0, "cannot be written; check that its folder exists and is writable");
  }
}

void TextFile::line(std::string_view text) {
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  stream_ << text << '\n';
}

void TextFile::labelled(std::string_view text, std::string_view label) {
  std::string whole(text.substr(0, 60));
  whole.resize(60, ' ');
  line(whole.append(label));
}

void TextFile::close() {
  stream_.close();
  if (!stream_) throw FileError(path_, 0, "could not be written to the end; check the free space");
}

}  // namespace leonav::sim
