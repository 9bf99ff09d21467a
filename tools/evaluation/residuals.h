// What an estimator left of its measurements, per system, observable and elevation.
#pragma once
#include <array>
#include <string>
#include <vector>

namespace leonav {

// Lower bounds of the elevation bins, degrees; the last one ends at the zenith.
inline constexpr std::array<double, 6> kElevationBins = {0.0, 10.0, 20.0, 30.0, 45.0, 60.0};
inline constexpr double kResidualElevation_deg = 20.0;  // what counts as well received

struct ResidualBin {
  long count = 0;
  double rms = 0.0, mean = 0.0;  // m, m/s
};

struct ResidualRow {
  std::string system, observable;  // "gps", "carrier"
  ResidualBin high;                // from kResidualElevation_deg up
  std::array<ResidualBin, kElevationBins.size()> bins;
};

// Reads measurements.csv of leonav-replay and takes what counted (used or downweighted). Throws
// FileError where the file is not one, or nothing in it counted.
std::vector<ResidualRow> read_residuals(const std::string& path);

std::string to_table(const std::vector<ResidualRow>& rows);

}  // namespace leonav
