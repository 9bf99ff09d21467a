#include "drivers/imu_line/line_layout.h"

#include <algorithm>
#include <cstdlib>

namespace leonav {
namespace {

long count(const LineLayout& layout, LineColumn column) {
  return std::count(layout.columns.begin(), layout.columns.end(), column);
}

bool is_permutation(const std::array<int, 3>& axes) {
  std::array<int, 3> sorted = axes;
  for (int& axis : sorted) axis = std::abs(axis);
  std::sort(sorted.begin(), sorted.end());
  return sorted == std::array{1, 2, 3};
}

// Of a mirrored set of axes no rotation could make a vehicle's.
bool is_right_handed(const std::array<int, 3>& axes) {
  const auto sign = [](int value) { return value < 0 ? -1 : 1; };
  int inversions = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = i + 1; j < 3; ++j) inversions += std::abs(axes[i]) > std::abs(axes[j]);
  }
  const int signs = sign(axes[0]) * sign(axes[1]) * sign(axes[2]);
  return (inversions % 2 == 0 ? signs : -signs) == 1;
}

}  // namespace

std::string problem_of(const LineLayout& layout) {
  using enum LineColumn;
  for (const LineColumn column : {kGyroX, kGyroY, kGyroZ, kAccelX, kAccelY, kAccelZ}) {
    if (count(layout, column) != 1) {
      return "columns must name gyro_x, gyro_y, gyro_z, accel_x, accel_y and accel_z once each";
    }
  }
  const long weeks = count(layout, kGpsWeek), tows = count(layout, kGpsTowS);
  if (weeks != tows || weeks > 1) return "gps_week and gps_tow_s go together, once each";
  const long clocks = count(layout, kClockS) + count(layout, kClockMs) + count(layout, kClockUs) +
                      count(layout, kClockNs);
  if (clocks > 1) return "columns may name one clock_* only";
  if (count(layout, kIntervalS) > (layout.are_increments ? 1 : 0)) {
    return "interval_s is for increments, once";
  }
  if (!is_permutation(layout.axes))
    return "axes must name x, y and z once each, such as [x, -y, -z]";
  if (!is_right_handed(layout.axes)) {
    return "axes are mirrored: no sensor is mounted so; one sign is wrong, or two names are "
           "swapped";
  }
  return "";
}

}  // namespace leonav
