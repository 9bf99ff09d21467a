// Ocean loading of stations in the BLQ format.
// Source: IERS Conventions (2010), 7.1.2; H.-G. Scherneck, M. S. Bos, Ocean Tide and Atmospheric
// Loading, IVS 2002 General Meeting Proceedings.
#pragma once
#include <Eigen/Core>
#include <string>
#include <string_view>

#include "core/earth/tides.h"

namespace leonav {

// As the format has them, a column per OceanLoading::Constituent: amplitudes up, west, south in m,
// then their phases in degrees. Not yet radians, so that they can be written again digit by digit.
using BlqRows = Eigen::Matrix<double, 6, OceanLoading::kConstituents>;

struct BlqStation {
  std::string name;  // as in the file
  long line = 0;     // of the name
  BlqRows rows = BlqRows::Zero();
};

// What makes the value impossible, in words; nullptr if nothing does: amplitudes from 0 to 0.5 m
// (the largest of the sea are a few decimetres), phases within a turn of zero.
const char* blq_fault(int row, double value);

OceanLoading ocean_loading(const BlqRows& rows);

// The station named, without regard to case: by its whole name, or by the first word of it where
// that fits one station only. An empty name: the only station of the file. Damage to other stations
// does not matter. Throws FileError if the file cannot be read, has its columns in another order,
// is cut off within the station, or if the station is damaged, there twice or not at all; the
// message then names those that are there.
BlqStation read_blq(const std::string& path, std::string_view station);

}  // namespace leonav
