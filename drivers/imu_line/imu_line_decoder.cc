#include "drivers/imu_line/imu_line_decoder.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>

#include "core/base/calendar.h"
#include "drivers/text/parse.h"

namespace leonav {
namespace {

using Vector = ImuLine::Vector;

// Beyond what sensors measure; the service refuses larger ones too. Increments are checked with
// their interval by who makes samples of them.
constexpr double kMaxRate_rad_s = 35.0, kMaxForce_m_s2 = 500.0;
constexpr double kMaxClock_ns = 4e18;  // 127 years

bool are_within(const Vector& values, double limit) {
  return std::all_of(values.begin(), values.end(),
                     [limit](double value) { return std::abs(value) <= limit; });
}

Vector turned(const Vector& from, const std::array<int, 3>& axes, double unit) {
  Vector to{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double value = from[static_cast<std::size_t>(std::abs(axes[i])) - 1] * unit;
    to[i] = axes[i] < 0 ? -value : value;
  }
  return to;
}

double clock_unit_ns(LineColumn column) {
  switch (column) {
    case LineColumn::kClockS:
      return 1e9;
    case LineColumn::kClockMs:
      return 1e6;
    case LineColumn::kClockUs:
      return 1e3;
    default:
      return 1.0;
  }
}

}  // namespace

void ImuLineDecoder::begin_connection() {
  text_.clear();
  is_first_ = is_dropped_ = true;
}

void ImuLineDecoder::feed(std::span<const std::uint8_t> bytes, ImuLineHandler* handler) {
  for (const std::uint8_t byte : bytes) {
    if (byte == '\n' || byte == '\r') {
      if (!is_dropped_) decode(text_, handler);
      counters_.first_lines += is_first_;
      text_.clear();
      is_dropped_ = is_first_ = false;
    } else if (is_dropped_) {
      continue;
    } else if (text_.size() < kMaxLine) {
      text_.push_back(static_cast<char>(byte));
    } else {
      is_dropped_ = true;
      ++counters_.too_long;
    }
  }
}

// A word must end where the prefix ends, so that "IMU" is not found in "IMU2". A prefix that ends
// with a separator or another sign, as "$", ends by itself.
bool ImuLineDecoder::has_prefix(std::string_view text) const {
  const std::string& prefix = layout_.prefix;
  if (!text.starts_with(prefix)) return false;
  if (prefix.empty() || text.size() == prefix.size()) return true;
  const auto is_of_word = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
  };
  const char next = text[prefix.size()];
  return !is_of_word(prefix.back()) || next == layout_.separator || next == ' ' || next == '\t';
}

void ImuLineDecoder::decode(std::string_view text, ImuLineHandler* handler) {
  if (text.empty()) return;  // also between CR and LF
  if (trim(text).empty() || !has_prefix(text)) {
    ++counters_.other_lines;
    return;
  }
  if (layout_.has_checksum && !take_checksum(&text)) {
    ++counters_.bad_checksums;
    return;
  }
  text.remove_prefix(layout_.prefix.size());
  split(text);
  if (fields_.size() != layout_.columns.size()) {
    ++counters_.bad_columns;
    return;
  }
  ImuLine line;
  if (!read(&line)) {
    ++counters_.bad_values;
    return;
  }
  ++counters_.lines;
  handler->on_line(line);
}

// Cuts "*HH" off; false where it is missing or wrong.
bool ImuLineDecoder::take_checksum(std::string_view* text) {
  const std::size_t star = text->rfind('*');
  if (star == std::string_view::npos || text->size() != star + 3) return false;
  unsigned stated = 0;
  const char* end = text->data() + text->size();
  if (std::from_chars(text->data() + star + 1, end, stated, 16).ptr != end) return false;
  unsigned sum = 0;
  for (const char c : text->substr(0, star)) {
    if (c != '$') sum ^= static_cast<unsigned char>(c);
  }
  *text = text->substr(0, star);
  return sum == stated;
}

// What follows the prefix may begin with a separator; it is none of the columns'.
void ImuLineDecoder::split(std::string_view text) {
  const bool blanks = layout_.separator == ' ';
  fields_.clear();
  if (!layout_.prefix.empty() && !text.empty() && text.front() == layout_.separator) {
    text.remove_prefix(1);
  }
  while (true) {
    if (blanks) text = trim(text);
    if (blanks && text.empty()) return;
    const std::size_t end = blanks ? text.find_first_of(" \t") : text.find(layout_.separator);
    fields_.push_back(trim(text.substr(0, end)));
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
  }
}

// A leap by more than half of the counter's range is its end, or a line that has been read wrongly:
// then the next one leaps back. A clock that counts on beyond the range is left as it is.
// WrappedCounter does not serve: it takes whole numbers of 32 bits at most, which are here numbers
// with decimals (clock_s) of up to 64 bits, and would cut off what a clock has counted beyond.
double ImuLineDecoder::continued_clock(double value) {
  const double range = std::ldexp(1.0, layout_.clock_bits);
  const auto is_inside = [range](double clock) { return clock >= 0.0 && clock < range; };
  if (is_inside(value) && is_inside(last_clock_)) {
    if (last_clock_ - value > 0.5 * range) {
      before_wraps_ += range;
    } else if (value - last_clock_ > 0.5 * range && before_wraps_ > 0.0) {
      before_wraps_ -= range;
    }
  }
  last_clock_ = value;
  return before_wraps_ + value;
}

bool ImuLineDecoder::read(ImuLine* line) {
  using enum LineColumn;
  Vector gyro{}, accel{};
  double week = -1.0, tow_s = -1.0;
  std::optional<double> clock;
  double unit_ns = 1.0;
  for (std::size_t i = 0; i < fields_.size(); ++i) {
    const LineColumn column = layout_.columns[i];
    if (column == kSkip) continue;
    const std::optional<double> value = parse_double(fields_[i]);
    if (!value) return false;
    if (column >= kGyroX && column <= kGyroZ) {
      gyro[static_cast<std::size_t>(column) - static_cast<std::size_t>(kGyroX)] = *value;
    } else if (column >= kAccelX && column <= kAccelZ) {
      accel[static_cast<std::size_t>(column) - static_cast<std::size_t>(kAccelX)] = *value;
    } else if (column == kGpsWeek) {
      week = *value;
    } else if (column == kGpsTowS) {
      tow_s = *value;
    } else if (column == kIntervalS) {
      line->interval_s = *value;
    } else {
      clock = value;
      unit_ns = clock_unit_ns(column);
      if (std::abs(*clock) * unit_ns > kMaxClock_ns) return false;
    }
  }
  const bool has_gps =
      week >= 1.0 && week <= kLastGpsWeek && tow_s >= 0.0 && tow_s < kSecondsPerWeek;
  if (has_gps) line->gps_time = GpsTime::from_week_and_tow(static_cast<int>(week), tow_s);
  line->gyro = turned(gyro, layout_.axes, layout_.gyro_unit);
  line->accel = turned(accel, layout_.axes, layout_.accel_unit);
  if (!are_within(line->gyro, kMaxRate_rad_s) || !are_within(line->accel, kMaxForce_m_s2)) {
    return false;
  }
  // Last, so that a line that is refused does not count as one whose clock was read.
  if (!clock) return true;
  const double clock_ns = continued_clock(*clock) * unit_ns;
  if (std::abs(clock_ns) > kMaxClock_ns) return false;
  line->clock_ns = std::llround(clock_ns);
  return true;
}

}  // namespace leonav
