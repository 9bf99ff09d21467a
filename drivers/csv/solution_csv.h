// This unit writes and reads solution.csv: the truth columns, then uncertainty, source and geometry
// of each solution.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/navigator/interface/solution.h"
#include "drivers/csv/csv_writer.h"
#include "drivers/csv/truth_csv.h"

namespace leonav {

inline constexpr std::string_view kSolutionCsvHeader =
    "gps_week,gps_tow_s,latitude_deg,longitude_deg,height_m,v_north_m_s,v_east_m_s,v_down_m_s,"
    "roll_deg,pitch_deg,yaw_deg,std_north_m,std_east_m,std_down_m,std_v_north_m_s,std_v_east_m_s,"
    "std_v_down_m_s,std_roll_deg,std_pitch_deg,std_yaw_deg,source,satellites,pdop,"
    "protection_horizontal_m,protection_vertical_m,protection_heading_deg";

// One row, in the frames of the truth file.
struct SolutionRow {
  TruthPoint pva;                            // position, velocity, attitude; no attitude: empty
  std::optional<Eigen::Vector3d> sigma_p_n;  // m, 1 sigma north east down
  std::optional<Eigen::Vector3d> sigma_v_n;  // m/s
  std::optional<Eigen::Vector3d> sigma_rpy;  // rad
  Source source = Source::kNone;
  std::optional<int> satellites;
  std::optional<double> pdop;
  std::optional<double> horizontal_protection_m, vertical_protection_m;
  std::optional<double> heading_protection;  // rad
};

// Converts a solution to a row; satellites and pdop come from the epoch on which it is based.
SolutionRow to_solution_row(const Solution& solution, std::optional<int> satellites,
                            std::optional<double> pdop);

// Returns whether a row carries the course of before on without GNSS and without an IMU, which
// shows by INS as the source of what has no attitude. In lines and statistics it is part of a gap.
bool is_prediction(const SolutionRow& row);

// Returns the name of a source in tables and exports: that of to_string(), but "prediction" and not
// "ins" where there is no attitude: without GNSS no IMU carries the answer on either.
std::string_view source_name(Source source, bool has_attitude);
// The same of a row.
std::string_view source_name(const SolutionRow& row);

// Writes the digits of truth.csv; sigmas and protection levels 1e-4 m and m/s, 1e-6 deg;
// pdop 1e-2.
class SolutionCsvWriter {
 public:
  explicit SolutionCsvWriter(const std::string& path);  // throws FileError
  void write(const SolutionRow& row);
  void close();  // throws FileError if anything could not be written
  long rows() const { return rows_; }

 private:
  CsvWriter writer_;
  long rows_ = 0;
};

// Contents of a file.
struct SolutionCsv {
  std::vector<SolutionRow> rows;  // times strictly increasing
  CsvReport report;
};

// Reads a whole file by the rules of read_truth_csv: only time and position are required.
SolutionCsv read_solution_csv(const std::string& path);

}  // namespace leonav
