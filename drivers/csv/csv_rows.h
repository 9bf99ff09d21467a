// Rows of a comma-separated file with a header line: fields by column name, bad rows counted.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/time/gps_time.h"
#include "drivers/text/line_reader.h"
#include "drivers/text/stamp_order.h"

namespace leonav {

// What a reader left out. A bad row costs itself and nothing else.
struct CsvReport {
  long rows = 0;                      // used
  long skipped = 0;                   // not used
  std::vector<std::string> problems;  // "FILE:LINE: what", the first kMaxProblems lines
  static constexpr std::size_t kMaxProblems = 10;
};

class CsvRows {
 public:
  // Opens and reads the header line. Throws FileError, saying `expected_header`, if one of the
  // comma-separated names in `required` is not a column.
  CsvRows(const std::string& path, std::string_view required, std::string_view expected_header);

  // Column of that name, or -1.
  int column(std::string_view name) const;

  // Goes to the next row that is not blank; false at the end. Counts the last row as used unless
  // skip() was called.
  bool next();

  bool blank(int column) const;  // absent or empty
  // The field as a number; nullopt if blank. Text that is no finite number makes the row bad().
  std::optional<double> number(int column);
  std::string_view text(int column) const;
  // Week and time of week; unset, and the row bad(), if blank or out of range.
  GpsTime time(int week_column, int tow_column);
  // Bad too is a row with another number of fields than the header.
  bool bad() const { return !why_bad_.empty(); }
  void mark_bad(const std::string& why);

  // Counts the current row as not used, for the reason mark_bad() or a bad field gave.
  void skip();

  // After the last row: of the rows used, takes out those whose stamp contradicts the stamps around
  // it, and counts them as not used. `rows` holds one element per row that was used.
  template <typename Row, typename TimeOf>
  void drop_disordered(std::vector<Row>* rows, TimeOf time_of);

  // Throws FileError if no row was used. To be called at the end.
  CsvReport finish();

 private:
  void add_problem(long line, const std::string& what);
  // Of the rows used, by their stamps; the others are counted.
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
