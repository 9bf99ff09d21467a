// Files of lines in fixed columns.
#pragma once
#include <fstream>
#include <string>
#include <string_view>

#include "core/time/calendar.h"

namespace leonav::sim {

// As std::snprintf formats, which the C locale rules: a program that leaves it alone writes the
// same text on every machine.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

// The calendar of `time` with its seconds rounded to `decimals` (at most 9), carried where they
// would read 60.
CalendarTime rounded_calendar(GpsTime time, int decimals);

// Every failure to write is an error, at the latest in close().
class TextFile {
 public:
  // Throws FileError if the file cannot be made.
  explicit TextFile(const std::string& path);

  void line(std::string_view text);
  // RINEX and ANTEX headers: `text` in columns 1 to 60, `label` behind.
  void labelled(std::string_view text, std::string_view label);

  // Throws FileError if anything could not be written.
  void close();

 private:
  std::string path_;
  std::ofstream stream_;
};

}  // namespace leonav::sim
