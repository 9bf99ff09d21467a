// This unit reads the rows of a comma-separated file with a header line: fields by column name, bad
// rows counted.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/gps_time.h"
#include "drivers/text/line_reader.h"
#include "drivers/text/stamp_order.h"

namespace leonav {

// What a row needs, to be a position at a time.
inline constexpr std::string_view kPositionColumns =
    "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m";

// Counts of a reader's rows. A bad row excludes only itself.
struct CsvReport {
  long rows = 0;                      // used
  long skipped = 0;                   // not used
  std::vector<std::string> problems;  // "FILE:LINE: error", the first kMaxProblems lines
  static constexpr std::size_t kMaxProblems = 10;
};

// CsvRows iterates over the rows of one file; a bad field makes its row bad().
class CsvRows {
 public:
  // Opens the file and reads the header line. Throws FileError, quoting `expected_header`, if one
  // of the comma-separated names in `required` is not a column.
  CsvRows(const std::string& path, std::string_view required, std::string_view expected_header);

  // Returns the column with that name, or -1.
  int column(std::string_view name) const;

  // Goes to the next row that is not blank; returns false at the end. It counts the last row as
  // used unless skip() was called.
  bool next();

  bool blank(int column) const;  // absent or empty
  // Returns the field as a number, or nullopt if blank. Text that is no finite number makes the row
  // bad().
  std::optional<double> number(int column);
  std::string_view text(int column) const;
  // Returns the instant of week and time of week; it is unset, and the row bad(), where they are
  // blank or out of range.
  GpsTime time(int week_column, int tow_column);
  // A row whose number of fields differs from the header's is bad too.
  bool bad() const { return !why_bad_.empty(); }
  void mark_bad(const std::string& why);

  // Counts the current row as not used, with the reason of mark_bad() or of a bad field.
  void skip();

  // Removes, after the last row, those used rows whose stamp contradicts the stamps around it, and
  // counts them as not used. `rows` must have one element per row that was used.
  template <typename Row, typename TimeOf>
  void drop_disordered(std::vector<Row>* rows, TimeOf time_of);

  // Ends the reading. Throws FileError if no row was used.
  CsvReport finish();

 private:
  void add_problem(long line, const std::string& what);
  // Decides which of the used rows are in order, by their stamps, and counts the others.
  std::vector<bool> rows_in_order(std::span<const GpsTime> stamps);

  LineReader reader_;
  std::vector<std::string> names_;
  std::string line_;
  std::vector<std::string_view> fields_;
  std::string why_bad_;
  bool counted_ = true;  // the current row is in the report
  CsvReport report_;
  std::vector<long> problem_lines_, used_lines_;
};

template <typename Row, typename TimeOf>
void CsvRows::drop_disordered(std::vector<Row>* rows, TimeOf time_of) {
  std::vector<GpsTime> stamps;
  stamps.reserve(rows->size());
  for (const Row& row : *rows) stamps.push_back(time_of(row));
  const std::vector<bool> in_order = rows_in_order(stamps);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < in_order.size(); ++i) {
    if (in_order[i]) (*rows)[kept++] = (*rows)[i];
  }
  rows->erase(rows->begin() + static_cast<std::ptrdiff_t>(kept), rows->end());
}

}  // namespace leonav
