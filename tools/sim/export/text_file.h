// TextFile writes files of lines in fixed columns.
#pragma once
#include <fstream>
#include <string>
#include <string_view>

#include "core/base/calendar.h"

namespace leonav::sim {

// Formats like std::snprintf in the C locale: a program that does not change the locale writes the
// same text on every machine.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

// Returns the calendar of `time` with seconds rounded to `decimals` (at most 9), with a carry where
// they would be 60.
CalendarTime rounded_calendar(GpsTime time, int decimals);

// TextFile reports every failed write, at the latest in close().
class TextFile {
 public:
  // Throws FileError if the file cannot be created.
  explicit TextFile(const std::string& path);

  void line(std::string_view text);
  // Writes a header line of RINEX or ANTEX: `text` in columns 1 to 60, then `label`.
  void labelled(std::string_view text, std::string_view label);

  // Throws FileError if anything could not be written.
  void close();

 private:
  std::string path_;
  std::ofstream stream_;
};

}  // namespace leonav::sim
