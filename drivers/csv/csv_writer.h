// This unit writes rows of numbers as the same text on every machine, whatever its locale.
#pragma once
#include <fstream>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/gps_time.h"

namespace leonav {

// The writer makes a file of rows; every failure to write is an error, at the latest in close().
class CsvWriter {
 public:
  // Throws FileError if the file cannot be created.
  CsvWriter(const std::string& path, std::string_view header);

  CsvWriter& time(GpsTime time);  // two fields: week, time of week with all its digits
  CsvWriter& number(double value, int decimals);  // empty field where not finite
  CsvWriter& number(const std::optional<double>& value, int decimals);
  CsvWriter& text(std::string_view text);
  void end_row();

  // Throws FileError if anything could not be written.
  void close();

 private:
  void separate();
  std::string path_;
  std::ofstream stream_;
  std::string row_;
  bool first_ = true;
};

}  // namespace leonav
