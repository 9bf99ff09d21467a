#include "tools/connect/formats/inertial/imu_line_format.h"

namespace leonav {

void ImuLineFormat::feed(std::span<const std::uint8_t> bytes, std::int64_t arrival_ns) {
  arrival_ns_ = arrival_ns;
  decoder_.feed(bytes, this);
}

void ImuLineFormat::on_line(const ImuLine& line) {
  ImuReading reading;
  reading.arrival_ns = arrival_ns_;
  reading.gps_time = line.gps_time;
  reading.clock_ns = line.clock_ns;
  reading.are_increments = are_increments_;
  reading.interval_s = line.interval_s;
  reading.gyro = {line.gyro[0], line.gyro[1], line.gyro[2]};
  reading.accel = {line.accel[0], line.accel[1], line.accel[2]};
  take(reading);
}

FormatCounts ImuLineFormat::counts() const {
  const ImuLineCounters& c = decoder_.counters();
  FormatCounts counts;
  counts.frames = c.lines;
  counts.damaged = c.bad_checksums + c.bad_columns + c.too_long;
  counts.refused = c.bad_values;
  add_to(&counts);
  return counts;
}

std::string ImuLineFormat::why_no_frames() const {
  const ImuLineCounters& c = decoder_.counters();
  if (c.bad_columns > 0) {
    return "lines arrive with another number of columns than 'line.columns' names, or with another "
           "'line.separator'";
  }
  if (c.bad_checksums > 0) return "every line's checksum is wrong or missing: see 'line.checksum'";
  if (c.bad_values > 0) {
    return "lines arrive whose columns are no numbers, or beyond any sensor: see 'line.columns' "
           "and the units";
  }
  if (c.other_lines > 0) return "no line begins with 'line.prefix' and a separator";
  return "bytes arrive but no line: is the baud rate right, and does the sensor write text?";
}

}  // namespace leonav
