#include "drivers/rinex/navigation_reader.h"

#include <cmath>
#include <optional>

#include "drivers/rinex/calendar_fields.h"
#include "drivers/rinex/navigation_record.h"
#include "drivers/rinex/navigation_record_4.h"
#include "drivers/rinex/satellite_refusal.h"
#include "drivers/text/line_reader.h"

namespace leonav {
namespace {

// Layout of the records, and whether they are those of RINEX 4.
struct FileLayout {
  NavigationLayout record;
  bool is_version_4 = false;
};

FileLayout read_first_line(LineReader* lines) {
  std::string_view line;
  if (!lines->next(line)) throw FileError(lines->path(), 0, "the file is empty");
  const std::string_view label = trim(columns(line, 60, 20));
  const auto version = parse_double(columns(line, 0, 9));
  const auto fail = [lines](const std::string& what) {
    throw FileError(lines->path(), lines->line_number(), what);
  };
  if (label != "RINEX VERSION / TYPE" || !version) {
    fail("does not begin with a RINEX VERSION / TYPE line; give a RINEX navigation file");
  }
  if (!(*version >= 2.0 && *version < 5.0)) {
    fail("RINEX version " + std::string(trim(columns(line, 0, 9))) +
         " is not supported (2.00 to 4 are); convert the file to version 3");
  }
  FileLayout result;
  result.is_version_4 = *version >= 4.0;
  NavigationLayout& layout = result.record;
  layout.is_version_2 = *version < 3.0;
  const std::string_view type = columns(line, 20, 1);
  // RINEX 2 has a file type for each system: N GPS, G GLONASS, H SBAS, E Galileo, J QZSS.
  const bool known = type == "N" || (layout.is_version_2 &&
                                     (type == "G" || type == "H" || type == "E" || type == "J"));
  if (!known) {
    fail("this RINEX file is of type '" + std::string(trim(columns(line, 20, 20))) +
         "', not a navigation file; list it under its own key");
  }
  if (type == "G") layout.system = 'R';
  if (type == "H") layout.system = 'S';
  if (type == "E") layout.system = 'E';
  if (type == "J") layout.system = 'J';
  return result;
}

// Reads four coefficients of 12 columns each.
bool read_coefficients(std::string_view line, std::size_t start, std::array<double, 4>* result) {
  for (std::size_t i = 0; i < 4; ++i) {
    const auto value = parse_double(columns(line, start + 12 * i, 12));
    if (!value) return false;
    (*result)[i] = *value;
  }
  return true;
}

void read_rest_of_header(LineReader* lines, NavigationFile* file) {
  bool has_alpha = false, has_beta = false;
  std::string_view line;
  while (true) {
    if (!lines->next(line)) {
      throw FileError(lines->path(), lines->line_number(), "the file ends within its header");
    }
    const std::string_view label = trim(columns(line, 60, 20));
    if (label == "END OF HEADER") break;
    const std::string_view kind = columns(line, 0, 4);
    const bool v3 = label == "IONOSPHERIC CORR";
    bool ok = true;
    if (label == "ION ALPHA" || (v3 && kind == "GPSA")) {
      ok = has_alpha = read_coefficients(line, v3 ? 5 : 2, &file->klobuchar.alpha);
    } else if (label == "ION BETA" || (v3 && kind == "GPSB")) {
      ok = has_beta = read_coefficients(line, v3 ? 5 : 2, &file->klobuchar.beta);
    }
    if (!ok) file->counts.skip("ionosphere line that is not readable", lines->line_number());
  }
  file->klobuchar.valid = has_alpha && has_beta;
}

void take_record_4(const std::vector<std::string>& lines, long line_number, NavigationFile* file) {
  NavigationRecord4 record;
  const std::string_view reason = parse_record_4(lines, &record);
  file->delays.insert(file->delays.end(), record.delays.begin(), record.delays.end());
  if (record.klobuchar && !file->klobuchar.valid) file->klobuchar = *record.klobuchar;
  if (record.ephemeris) file->ephemerides.push_back(*record.ephemeris);
  if (reason.empty()) {
    ++file->counts.used;
  } else {
    file->counts.skip(reason, line_number);
  }
}

void take_record(const std::vector<std::string>& record, long line_number,
                 const NavigationLayout& layout, NavigationFile* file) {
  std::string_view reason = satellite_refusal(record_satellite(record[0], layout));
  Ephemeris ephemeris;
  if (reason.empty()) reason = parse_navigation_record(record, layout, &ephemeris);
  if (!reason.empty()) {
    file->counts.skip(reason, line_number);
    return;
  }
  file->ephemerides.push_back(ephemeris);
  ++file->counts.used;
}

}  // namespace

NavigationFile read_navigation(const std::string& path) {
  // The longest record has eight lines, eleven in RINEX 4. Lines that follow without a satellite
  // name are junk, of which a line or two suffice to recognize the record as damaged.
  constexpr std::size_t kMaxLines = 16;
  LineReader lines(path);
  NavigationFile file;
  const FileLayout layout = read_first_line(&lines);
  read_rest_of_header(&lines, &file);
  std::vector<std::string> record;
  long record_line = 0;
  const auto take = [&] {
    if (record.empty()) return;
    if (layout.is_version_4) {
      take_record_4(record, record_line, &file);
    } else {
      take_record(record, record_line, layout.record, &file);
    }
  };
  std::string_view line;
  while (lines.next(line)) {
    if (layout.is_version_4 ? starts_record_4(line, record.size())
                            : starts_navigation_record(line, layout.record)) {
      take();
      record.assign(1, std::string(line));
      record_line = lines.line_number();
    } else if (record.empty()) {
      if (!is_blank(line)) file.counts.skip("line outside a record", lines.line_number());
    } else if (record.size() < kMaxLines) {
      record.emplace_back(line);
    }
  }
  take();
  return file;
}

}  // namespace leonav
