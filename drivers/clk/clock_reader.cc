#include "drivers/clk/clock_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/calendar.h"
#include "drivers/text/time_system.h"

namespace leonav {
namespace {

constexpr std::size_t kMaxProblems = 20;
constexpr double kMaxClock = 0.1;  // s; the widest satellite clocks drift to some ms
constexpr int kMaxValues = 6;      // in a record: two on its line, four on the next
// Number of fields before: year to second, number of values.
constexpr std::size_t kValuesBegin = 7;

// Labels are in column 61 up to version 3.03 and in column 66 from 3.04 on.
bool has_label(std::string_view line, std::string_view label) {
  return line.size() > 60 && line.substr(60).find(label) != std::string_view::npos;
}

std::string_view first_word(std::string_view text) {
  const std::string_view trimmed = trim(text);
  return trimmed.substr(0, trimmed.find(' '));
}

bool is_letter(char c) { return c >= 'A' && c <= 'Z'; }

bool is_other_system(std::string_view name) {
  return name.size() == 3 && is_letter(name[0]) && parse_int(name.substr(1)).has_value();
}

PreciseState without_position() {
  PreciseState state;
  state.p_e.setConstant(std::numeric_limits<double>::quiet_NaN());
  return state;
}

}  // namespace

ClockReader::ClockReader(const std::string& path) : lines_(path) {
  read_first_line();
  read_header();
}

void ClockReader::read_first_line() {
  std::string_view line;
  if (!lines_.next(line)) {
    throw FileError(lines_.path(), 0, "is empty; expected a RINEX clock file");
  }
  const std::string_view word = first_word(line.substr(0, 20));
  const auto version = parse_double(word);
  if (!version || !has_label(line, "RINEX VERSION / TYPE")) {
    lines_.fail("does not begin like a RINEX file ('RINEX VERSION / TYPE'); check the file");
  }
  const std::string_view type = trim(columns(line, 20, 20));
  if (type.empty() || type[0] != 'C') {
    lines_.fail("is RINEX, but no clock file (type '" + std::string(type.substr(0, 1)) +
                "'); under 'clocks' give files of type C");
  }
  version_ = *version;
  const bool known = version_ == 2.0 || (version_ > 2.995 && version_ < 3.045);
  if (!known) {
    lines_.fail("is of version " + std::string(word) + "; 2.00 and 3.00 to 3.04 are read");
  }
}

void ClockReader::read_header() {
  for (std::string_view line; lines_.next(line);) {
    if (has_label(line, "END OF HEADER")) return;
    if (has_label(line, "TIME SYSTEM ID")) set_time_system(first_word(line.substr(0, 60)));
  }
  throw FileError(lines_.path(), lines_.line_number(),
                  "ends within its header (no END OF HEADER); get the complete file");
}

void ClockReader::set_time_system(std::string_view name) {
  if (time_system_known_ || name.empty()) return;
  time_system_known_ = true;
  if (!is_known_time_system(name)) {
    lines_.fail("time system '" + std::string(name) +
                "' is not known; use a file in GPS, GAL, QZS, BDT, TAI or UTC time");
  }
  time_system_ = name;
}

bool ClockReader::next(ClockEpoch* epoch) {
  epoch->states.clear();
  if (has_next_epoch_clock_) epoch->states.push_back(next_epoch_clock_);
  has_next_epoch_clock_ = false;
  PreciseState state = without_position();
  for (std::string_view line; lines_.next(line);) {
    if (!read_record(line, &state)) continue;
    if (!epoch->states.empty() && state.time != epoch->states.front().time) {
      next_epoch_clock_ = state;
      has_next_epoch_clock_ = true;
      break;
    }
    epoch->states.push_back(state);
  }
  if (epoch->states.empty()) {
    if (counts_.states == 0) {
      throw FileError(lines_.path(), 0,
                      "holds no clock of a satellite that leonav uses; check that it is a complete "
                      "RINEX clock file with AS records");
    }
    return false;
  }
  epoch->time = epoch->states.front().time;
  auto& states = epoch->states;
  std::stable_sort(states.begin(), states.end(),
                   [](const auto& a, const auto& b) { return a.satellite < b.satellite; });
  const auto end = std::unique(states.begin(), states.end(), [](const auto& a, const auto& b) {
    return a.satellite == b.satellite;
  });
  for (auto again = end; again != states.end(); ++again) {
    damaged("clock of " + to_string(again->satellite) + " is given twice before here");
  }
  states.erase(end, states.end());
  counts_.states += states.size();
  return true;
}

// Returns whether the line is a clock to be used.
bool ClockReader::read_record(std::string_view line, PreciseState* state) {
  if (continuation_lines_ > 0 && !line.empty() && line[0] == ' ') {
    --continuation_lines_;  // uncertainties of the rate, and the acceleration: not used
    return false;
  }
  continuation_lines_ = 0;
  if (trim(line).empty()) return false;
  if (line.size() < 3 || !is_letter(line[0]) || !is_letter(line[1]) || line[2] != ' ') {
    return damaged("record is unreadable");
  }
  field_count_ = 0;
  for (std::string_view rest = trim(columns(line, line.starts_with("AS") ? 6 : 13, line.size()));
       !rest.empty() && field_count_ < fields_.size();) {
    fields_[field_count_] = first_word(rest);
    rest = trim(rest.substr(fields_[field_count_++].size()));
  }
  // The length of receivers' names depends on the version, so records other than AS are not parsed.
  // A continuation line may follow them.
  if (!line.starts_with("AS")) {
    ++counts_.other_records;
    continuation_lines_ = 1;
    return false;
  }
  if (field_count_ < kValuesBegin) return damaged("record is cut off");
  const auto values = parse_int(fields_[kValuesBegin - 1]);
  if (!values || *values < 1 || *values > kMaxValues) {
    return damaged("number of values is unreadable");
  }
  continuation_lines_ = *values > 2 ? 1 : 0;
  if (field_count_ - kValuesBegin < static_cast<std::size_t>(std::min(*values, 2))) {
    return damaged("record is cut off");
  }
  const std::string_view name = columns(line, 3, 3);
  const auto satellite = satellite_from_string(name);
  if (satellite) return read_clock(*satellite, state);
  if (!is_other_system(name)) return damaged("satellite name is unreadable");
  ++counts_.other_system;
  return false;
}

std::optional<GpsTime> ClockReader::read_time() const {
  std::array<int, 5> field{};  // year to minute
  for (std::size_t i = 0; i < field.size(); ++i) {
    const auto value = parse_int(fields_[i]);
    if (!value) return std::nullopt;
    field[i] = *value;
  }
  const auto [year, month, day, hour, minute] = field;
  const auto second = parse_double(fields_[5]);
  if (!second || year < 1980 || year > 2099 || month < 1 || month > 12 || day < 1 || day > 31 ||
      hour < 0 || hour > 23 || minute < 0 || minute > 59 || *second < 0.0 || *second >= 61.0) {
    return std::nullopt;
  }
  return gps_time_of(from_calendar({year, month, day, hour, minute, *second}), time_system_);
}

bool ClockReader::read_clock(SatelliteId satellite, PreciseState* state) {
  const auto time = read_time();
  if (!time) return damaged("time is unreadable");
  // The format is E19.12: a number without exponent was cut off.
  const std::string_view field = fields_[kValuesBegin];
  const bool complete = field.find_first_of("EeDd") != std::string_view::npos;
  const auto clock_s = complete ? parse_double(field) : std::nullopt;
  if (!clock_s) return damaged("clock is unreadable");
  if (std::abs(*clock_s) >= kMaxClock) {
    ++counts_.bad_clocks;
    return false;
  }
  state->satellite = satellite;
  state->time = *time;
  state->clock_s = *clock_s;
  return true;
}

bool ClockReader::damaged(const std::string& what) {
  ++counts_.damaged_lines;
  if (counts_.problems.size() < kMaxProblems) {
    counts_.problems.push_back({lines_.line_number(), what});
  }
  return false;
}

}  // namespace leonav
