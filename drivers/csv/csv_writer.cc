#include "drivers/csv/csv_writer.h"

#include <array>
#include <charconv>
#include <cmath>

#include "drivers/text/parse.h"

namespace leonav {

CsvWriter::CsvWriter(const std::string& path, std::string_view header)
    : path_(path), stream_(path, std::ios::binary | std::ios::trunc) {
  if (!stream_) {
    throw FileError(path, 0, "cannot be written; check that its folder exists and is writable");
  }
  stream_ << header << '\n';
}

void CsvWriter::separate() {
  if (!first_) row_ += ',';
  first_ = false;
}

CsvWriter& CsvWriter::time(GpsTime time) {
  const std::int64_t in_week = time.nanoseconds() - time.week() * kNanosecondsPerWeek;
  std::string fraction = std::to_string(in_week % kNanosecondsPerSecond);
  fraction.insert(0, 9 - fraction.size(), '0');
  while (fraction.size() > 3 && fraction.back() == '0') fraction.pop_back();
  text(std::to_string(time.week()));
  return text(std::to_string(in_week / kNanosecondsPerSecond) + "." + fraction);
}

CsvWriter& CsvWriter::number(double value, int decimals) {
  separate();
  std::array<char, 400> buffer;  // the largest double has 309 digits
  if (!std::isfinite(value)) return *this;
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value,
                                          std::chars_format::fixed, decimals);
  if (error == std::errc()) row_.append(buffer.data(), end);
  return *this;
}

CsvWriter& CsvWriter::number(const std::optional<double>& value, int decimals) {
  if (value) return number(*value, decimals);
  separate();
  return *this;
}

CsvWriter& CsvWriter::text(std::string_view text) {
  separate();
  row_ += text;
  return *this;
}

void CsvWriter::end_row() {
  row_ += '\n';
  stream_ << row_;
  row_.clear();
  first_ = true;
}

void CsvWriter::close() {
  stream_.close();
  if (!stream_) throw FileError(path_, 0, "could not be written to the end; check the free space");
}

}  // namespace leonav
