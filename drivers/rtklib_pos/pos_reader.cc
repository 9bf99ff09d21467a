#include "drivers/rtklib_pos/pos_reader.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <sstream>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "drivers/text/parse.h"
#include "drivers/text/stamp_order.h"

namespace leonav {
namespace {

// A time is "2021/04/28 22:19:22.430" or "2155 339562.430".
bool parse_time(const std::string& first, const std::string& second, GpsTime* time) {
  CalendarTime c;
  int week = 0;
  double tow_s = 0.0;
  if (std::sscanf(first.c_str(), "%d/%d/%d", &c.year, &c.month, &c.day) == 3) {
    if (std::sscanf(second.c_str(), "%d:%d:%lf", &c.hour, &c.minute, &c.second) != 3) return false;
    *time = from_calendar(c);
    return true;
  }
  if (std::sscanf(first.c_str(), "%d", &week) != 1) return false;
  if (std::sscanf(second.c_str(), "%lf", &tow_s) != 1) return false;
  *time = GpsTime::from_week_and_tow(week, tow_s);
  return true;
}

bool parse_row(const std::string& line, bool ecef, PosRow* row) {
  std::istringstream words(line);
  std::string first, second;
  Eigen::Vector3d position, sigma;
  if (!(words >> first >> second >> position.x() >> position.y() >> position.z())) return false;
  if (!position.allFinite() || !parse_time(first, second, &row->time)) return false;
  if (!(words >> row->quality >> row->satellites)) return false;
  const bool has_sigma = static_cast<bool>(words >> sigma.x() >> sigma.y() >> sigma.z());
  if (ecef) {
    row->position = to_geodetic(position);
  } else {
    row->position = {position.x() * kDegree, position.y() * kDegree, position.z()};
    if (has_sigma) row->sigma_neu = sigma;
  }
  return true;
}

void skip(long line, PosFile* file) {
  const bool first = file->skipped++ == 0;
  if (first || line < file->first_skipped_line) file->first_skipped_line = line;
}

}  // namespace

bool looks_like_pos(const std::string& path) {
  std::ifstream file(path);
  char first = 0;
  return file.get(first) && first == '%';
}

PosFile read_pos(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw FileError(path, 0, "cannot be opened; check the path");
  PosFile out;
  std::string line;
  bool ecef = false;
  std::vector<PosRow> rows;
  std::vector<long> numbers;
  std::vector<GpsTime> stamps;
  for (long number = 1; std::getline(file, line); ++number) {
    if (line.rfind('%', 0) == 0) {
      if (line.find("x-ecef") != std::string::npos) ecef = true;
      continue;
    }
    if (trim(line).empty()) continue;
    PosRow row;
    if (!parse_row(line, ecef, &row)) {
      skip(number, &out);
      continue;
    }
    rows.push_back(row);
    numbers.push_back(number);
    stamps.push_back(row.time);
  }
  const std::vector<bool> in_order = stamps_in_order(stamps);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (in_order[i]) {
      out.rows.push_back(rows[i]);
    } else {
      skip(numbers[i], &out);
    }
  }
  if (out.rows.empty()) throw FileError(path, 0, "no solution in the file");
  return out;
}

}  // namespace leonav
