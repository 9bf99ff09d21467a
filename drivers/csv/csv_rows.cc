#include "drivers/csv/csv_rows.h"

#include <algorithm>

namespace leonav {
namespace {

constexpr int kMaxWeek = 10'000;  // the year 2171

std::string shown(std::string_view text) {
  constexpr std::size_t kMaxShown = 40;
  std::string result;
  for (const char c : text.substr(0, kMaxShown)) {
    result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  }
  return text.size() > kMaxShown ? result + "..." : result;
}

}  // namespace

CsvRows::CsvRows(const std::string& path, std::string_view required,
                 std::string_view expected_header)
    : reader_(path) {
  std::string_view header;
  if (!reader_.next(header)) {
    throw FileError(path, 0, "is empty; expected the header " + std::string(expected_header));
  }
  if (header.starts_with("\xEF\xBB\xBF")) header.remove_prefix(3);  // byte-order mark
  split_csv(header, fields_);
  names_.assign(fields_.begin(), fields_.end());
  std::vector<std::string_view> wanted;
  split_csv(required, wanted);
  for (const std::string_view name : wanted) {
    if (column(name) < 0) {
      reader_.fail("header has no column '" + std::string(name) + "'; expected " +
                   std::string(expected_header));
    }
    if (std::count(names_.begin(), names_.end(), name) > 1) {
      reader_.fail("header has column '" + std::string(name) + "' twice; remove one");
    }
  }
}

int CsvRows::column(std::string_view name) const {
  const auto found = std::find(names_.begin(), names_.end(), name);
  return found == names_.end() ? -1 : static_cast<int>(found - names_.begin());
}

bool CsvRows::next() {
  if (!counted_) {
    ++report_.rows;
    used_lines_.push_back(reader_.line_number());
  }
  counted_ = true;
  std::string_view line;
  do {
    if (!reader_.next(line)) return false;
  } while (trim(line).empty());
  line_ = line;
  split_csv(line_, fields_);
  why_bad_.clear();
  counted_ = false;
  if (fields_.size() != names_.size()) {
    mark_bad("has " + std::to_string(fields_.size()) + " fields, the header " +
             std::to_string(names_.size()));
  }
  return true;
}

std::string_view CsvRows::text(int column) const {
  const bool there = column >= 0 && static_cast<std::size_t>(column) < fields_.size();
  return there ? fields_[static_cast<std::size_t>(column)] : std::string_view();
}

bool CsvRows::blank(int column) const { return text(column).empty(); }

std::optional<double> CsvRows::number(int column) {
  if (blank(column)) return std::nullopt;
  const std::optional<double> value = parse_double(text(column));
  if (!value) {
    mark_bad(names_[static_cast<std::size_t>(column)] + ": '" + shown(text(column)) +
             "' is not a finite number");
  }
  return value;
}

GpsTime CsvRows::time(int week_column, int tow_column) {
  const std::optional<int> week = parse_int(text(week_column));
  const std::optional<double> tow = parse_double(text(tow_column));
  if (!week || *week < 0 || *week > kMaxWeek) {
    mark_bad("GPS week '" + shown(text(week_column)) + "' is not a whole number from 0 to 10000");
    return {};
  }
  if (!tow || *tow < 0.0 || *tow >= static_cast<double>(kSecondsPerWeek)) {
    mark_bad("time of week '" + shown(text(tow_column)) + "' is not in 0 to 604800 s");
    return {};
  }
  const GpsTime time = GpsTime::from_week_and_tow(*week, *tow);
  if (!time.is_set()) mark_bad("week 0 and time of week 0 mean that there is no time");
  return time;
}

void CsvRows::mark_bad(const std::string& why) {
  if (why_bad_.empty()) why_bad_ = why;  // the first reason is the cause
}

void CsvRows::skip() {
  if (counted_) return;
  counted_ = true;
  ++report_.skipped;
  add_problem(reader_.line_number(), why_bad_.empty() ? "not used" : why_bad_);
}

void CsvRows::add_problem(long line, const std::string& what) {
  const auto place = std::upper_bound(problem_lines_.begin(), problem_lines_.end(), line);
  report_.problems.insert(report_.problems.begin() + (place - problem_lines_.begin()),
                          reader_.path() + ":" + std::to_string(line) + ": " + what);
  problem_lines_.insert(place, line);
  if (problem_lines_.size() <= CsvReport::kMaxProblems) return;
  problem_lines_.pop_back();
  report_.problems.pop_back();
}

std::vector<bool> CsvRows::rows_in_order(std::span<const GpsTime> stamps) {
  std::vector<bool> in_order = stamps_in_order(stamps);
  for (std::size_t i = 0; i < in_order.size(); ++i) {
    if (in_order[i]) continue;
    add_problem(used_lines_[i], "time does not fit the rows around it");
    ++report_.skipped;
    --report_.rows;
  }
  return in_order;
}

CsvReport CsvRows::finish() {
  if (report_.rows == 0) {
    std::string message = "has no usable row";
    if (!report_.problems.empty()) message += "; the first problem is " + report_.problems.front();
    throw FileError(reader_.path(), 0, message + "; check how the file was made");
  }
  return report_;
}

}  // namespace leonav
