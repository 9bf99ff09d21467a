// This unit decodes a stream of text lines to inertial measurements, by a described layout.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/gps_time.h"
#include "drivers/imu_line/line_layout.h"

namespace leonav {

// One line, in SI units, axes forward, right, down.
struct ImuLine {
  using Vector = std::array<double, 3>;

  std::optional<GpsTime> gps_time;
  std::optional<std::int64_t> clock_ns;  // the sensor's own clock
  std::optional<double> interval_s;      // of increments, where the line holds it
  // Angular rate (rad/s) and specific force (m/s^2), or their increments (rad, m/s).
  Vector gyro{}, accel{};
};

class ImuLineHandler {
 public:
  virtual ~ImuLineHandler() = default;
  virtual void on_line(const ImuLine& line) = 0;
};

struct ImuLineCounters {
  std::uint64_t lines = 0;        // decoded
  std::uint64_t first_lines = 0;  // of a connection, which may have lost their beginning
  std::uint64_t other_lines = 0;  // empty, or without the prefix
  std::uint64_t bad_checksums = 0;
  std::uint64_t bad_columns = 0;  // another number of columns
  std::uint64_t bad_values = 0;   // no number, or one beyond any sensor
  std::uint64_t too_long = 0;
};

// The decoder streams: chunks of any size, bounded memory. A damaged line costs itself only.
class ImuLineDecoder {
 public:
  static constexpr std::size_t kMaxLine = 1024;

  // Precondition: problem_of(layout) is empty.
  explicit ImuLineDecoder(LineLayout layout) : layout_(std::move(layout)) {}

  // A connection begins, in which the sender may be in the middle of a line: what the last one left
  // of a line is dropped, and so is everything up to the next end of a line.
  void begin_connection();
  void feed(std::span<const std::uint8_t> bytes, ImuLineHandler* handler);
  const ImuLineCounters& counters() const { return counters_; }

 private:
  void decode(std::string_view text, ImuLineHandler* handler);
  bool has_prefix(std::string_view text) const;
  bool take_checksum(std::string_view* text);
  void split(std::string_view text);
  bool read(ImuLine* line);
  double continued_clock(double value);

  LineLayout layout_;
  ImuLineCounters counters_;
  std::string text_;         // of the line that is not complete yet
  bool is_dropped_ = false;  // that line is too long or the first one, and dropped up to its end
  bool is_first_ = false;    // that line may have lost its beginning
  std::vector<std::string_view> fields_;
  double last_clock_ = 0.0;    // as the sensor wrote it, in its units
  double before_wraps_ = 0.0;  // what its clock had counted before it began again at zero
};

}  // namespace leonav
