// LineLayout describes the lines of an IMU that writes text: columns, units, axes.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace leonav {

// What a column holds.
enum class LineColumn : std::uint8_t {
  kSkip,
  kGyroX,
  kGyroY,
  kGyroZ,
  kAccelX,
  kAccelY,
  kAccelZ,
  kGpsWeek,
  kGpsTowS,
  kClockS,  // the sensor's own clock, whatever it counts from
  kClockMs,
  kClockUs,
  kClockNs,
  kIntervalS,  // of increments
};

struct LineLayout {
  std::vector<LineColumn> columns;
  char separator = ',';  // ' ' stands for any number of blanks and tabs
  // Lines that begin otherwise are left out; empty: none are. A separator or a blank must follow a
  // prefix whose last character is a letter or a digit.
  std::string prefix;
  bool has_checksum =
      false;  // "$...*HH" as in NMEA 0183: HH is the exclusive or of what is between
  int clock_bits =
      32;  // the sensor's clock may begin again at zero after 2^clock_bits of its units
  bool are_increments = false;  // integrals over the interval that ends at the line's time
  double gyro_unit = 1.0;       // rad/s (of increments rad) in one unit of the columns
  double accel_unit = 1.0;      // m/s^2 (of increments m/s) in one unit of the columns
  // Which of the line's axes points forward, right and down: 1 x, 2 y, 3 z; negative: against it.
  std::array<int, 3> axes = {1, 2, 3};
};

// Returns what keeps the layout from being read, as a sentence; empty: nothing.
std::string problem_of(const LineLayout& layout);

}  // namespace leonav
