// This unit reads the ocean loading of stations in the BLQ format. Source: IERS Conventions (2010),
// 7.1.2; H.-G. Scherneck, M. S. Bos, Ocean Tide and Atmospheric Loading, IVS 2002 General Meeting
// Proceedings.
#pragma once
#include <Eigen/Core>
#include <string>
#include <string_view>

#include "core/earth/tides.h"

namespace leonav {

// Rows as in the format, with a column per OceanLoading::Constituent: amplitudes up, west, south in
// m, then their phases in degrees. They are not converted to radians, so that they can be written
// again digit by digit.
using BlqRows = Eigen::Matrix<double, 6, OceanLoading::kConstituents>;

// One station of a file.
struct BlqStation {
  std::string name;  // as in the file
  long line = 0;     // of the name
  BlqRows rows = BlqRows::Zero();
};

// Returns why the value is impossible, as text, or nullptr if it is possible: amplitudes from 0 to
// 0.5 m (the largest at sea are a few decimetres), phases within a turn of zero.
const char* blq_fault(int row, double value);

OceanLoading ocean_loading(const BlqRows& rows);  // phases in rad

// Reads the station with that name, without regard to case: by its whole name, or by its first word
// where that fits one station only. An empty name selects the only station of the file. Damage to
// other stations does not matter. Throws FileError if the file cannot be read, has its columns in
// another order or is cut off within the station, or if the station is damaged, present twice or
// missing; the message then names the stations of the file.
BlqStation read_blq(const std::string& path, std::string_view station);

}  // namespace leonav
