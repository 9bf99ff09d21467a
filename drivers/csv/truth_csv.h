// This unit reads and writes truth.csv, the reference trajectory of the IMU centre. Fields of
// unknown values are empty; additional columns are allowed.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/gps_time.h"
#include "core/earth/ellipsoid.h"
#include "drivers/csv/csv_rows.h"
#include "drivers/csv/csv_writer.h"

namespace leonav {

inline constexpr std::string_view kTruthCsvHeader =
    "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m,v_north_m_s,v_east_m_s,v_down_m_s,"
    "roll_deg,pitch_deg,yaw_deg";

// State of the IMU centre at one instant.
struct TruthPoint {
  GpsTime time;
  Geodetic position;                       // height above the ellipsoid
  std::optional<Eigen::Vector3d> v_n;      // m/s, north east down; all three or none
  std::optional<double> roll, pitch, yaw;  // rad, yaw in (-pi, pi]
};

// Contents of a file.
struct TruthCsv {
  std::vector<TruthPoint> points;  // times strictly increasing
  CsvReport report;
};

// Reads a whole file. Columns are found by name; only time and position are required. Rows that do
// not parse, are out of range or whose time does not fit the rows around them are skipped and
// reported. Throws FileError if the header lacks a column or no row is usable.
TruthCsv read_truth_csv(const std::string& path);

// Writes 1e-10 deg (0.01 mm), 1e-4 m, 1e-6 m/s, 1e-8 deg of attitude, which suffices to start an
// inertial navigator that stays within a centimetre for minutes. Throws FileError.
void write_truth_csv(const std::string& path, std::span<const TruthPoint> points);

// The columns shared with solution.csv. read() takes the current row (see CsvRows::bad); write()
// appends to it.
class TruthColumns {
 public:
  explicit TruthColumns(const CsvRows& rows);
  TruthPoint read(CsvRows& rows) const;
  static void write(CsvWriter& writer, const TruthPoint& point);

 private:
  int week_, tow_, latitude_, longitude_, height_, v_north_, v_east_, v_down_, roll_, pitch_, yaw_;
};

// Reads three columns as one vector; nullopt unless all three have a number.
std::optional<Eigen::Vector3d> read_vector(CsvRows& rows, int x, int y, int z);

}  // namespace leonav
