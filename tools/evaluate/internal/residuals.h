// This unit summarizes the residuals of an estimator per system, observable and elevation.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace leonav {

// Lower bounds of the elevation bins, degrees; the last one ends at the zenith.
inline constexpr std::array<double, 6> kResidualElevations = {0.0, 10.0, 20.0, 30.0, 45.0, 60.0};
inline constexpr double kResidualElevation_deg = 20.0;  // limit of good reception

// Residuals in one elevation bin.
struct ResidualBin {
  long count = 0;
  double rms = 0.0, mean = 0.0;  // m, m/s
};

// Residuals of one system and observable.
struct ResidualRow {
  std::string system, observable;  // "gps", "carrier"
  ResidualBin high;                // at kResidualElevation_deg and above
  std::array<ResidualBin, kResidualElevations.size()> bins;
};

// Reads measurements.csv of leonav-replay and takes the rows that were used or downweighted. Throws
// FileError if the file has another format, or no such row.
std::vector<ResidualRow> read_residuals(const std::string& path);

// Formats the rows as a table.
std::string to_table(const std::vector<ResidualRow>& rows);

}  // namespace leonav
