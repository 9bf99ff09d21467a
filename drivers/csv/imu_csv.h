// This unit reads and writes imu.csv: rates and specific forces in body axes forward, right, down,
// with GPS time.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/inertial/strapdown/imu.h"
#include "drivers/csv/csv_rows.h"

namespace leonav {

inline constexpr std::string_view kImuCsvHeader =
    "gps_week,gps_tow_s,gyro_x_rad_s,gyro_y_rad_s,gyro_z_rad_s,accel_x_m_s2,accel_y_m_s2,accel_z_m_"
    "s2";

// Contents of a file: increments over intervals, in body axes.
struct ImuCsv {
  std::vector<ImuSample> samples;  // times strictly increasing
  CsvReport report;
  long gaps = 0;  // holes longer than kGapIntervals median intervals
  std::int64_t median_interval_ns = 0;
};

// Reads a whole file. Each row is the mean over (previous stamp, stamp]; the first row, and one
// after a gap, covers the median interval. Rows that do not parse, or whose time does not fit the
// rows around them, are skipped and reported. Throws FileError if the header differs or fewer than
// two rows are usable.
ImuCsv read_imu_csv(const std::string& path);
inline constexpr double kGapIntervals = 5.0;

// Writes 12 decimals of rad/s and 10 of m/s^2. Throws FileError.
void write_imu_csv(const std::string& path, std::span<const ImuSample> samples);

}  // namespace leonav
