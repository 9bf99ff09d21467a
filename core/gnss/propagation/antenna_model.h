// This unit models where a signal leaves and enters an antenna: the mean phase centre and its
// variation with direction. Patterns are those of ANTEX 1.4, one per band.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "core/base/capacity.h"
#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

// Variation in m at equidistant angles from the antenna's boresight (zenith angle at a receiver,
// nadir angle at a satellite) and azimuths. Values are stored row by row, one row per azimuth. A
// single row holds for every azimuth. Several rows are at 0, step, ... 2 pi, so that the first and
// the last have the same direction.
struct AntennaGrid {
  double first_angle = 0.0;  // rad
  double angle_step = 0.0;   // rad; 0 only with a single angle
  int angles = 0;            // per row; 0: no variation
  int azimuths = 0;          // rows: 0 (no variation), 1, or at least 3
  boost::container::static_vector<float, kMaxAntennaValues> values;
};

// A view of a grid that does not own the values, which the pattern store keeps in less space.
struct AntennaGridView {
  double first_angle = 0.0, angle_step = 0.0;
  int angles = 0, azimuths = 0;
  const float* values = nullptr;  // angles * azimuths
};
// Returns a view of `grid`, which must outlive it.
AntennaGridView view(const AntennaGrid& grid);

// The pattern of one band of one antenna, over its interval of validity.
struct AntennaPattern {
  bool is_receiver = false;
  // Satellite of the antenna. For a receiver antenna only the system of the signals counts (number
  // 0).
  SatelliteId satellite;
  char band = 0;        // '1'..'9' as in signal.h
  GpsTime valid_from;   // unset: always
  GpsTime valid_until;  // unset: without end
  // Satellite: from the centre of mass along the body's X, Y, Z (satellite_axes). Receiver: from
  // the antenna reference point to north, east, up of the antenna. Unit: m.
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  AntennaGrid variation;
};

// Returns whether the pattern is finite, its offset below 10 m, its variation below 1 m, its counts
// consistent, and its band one of the system's.
bool is_sane(const AntennaPattern& pattern);

// Returns whether the pattern is sane and fits AntennaPatternStore, which keeps for a satellite one
// row of at most kMaxNadirValues angles.
bool is_storable(const AntennaPattern& pattern);

// Returns the variation in m, bilinear; beyond the grid's angles it is the value at its end.
// `azimuth` is in rad, any turn: clockwise from north seen from above (receiver), from body Y
// towards X (satellite).
double variation_m(const AntennaGridView& grid, double angle, double azimuth);

// Returns the metres to ADD to the range from the centre of mass to get the range from the phase
// centre:
//   |p_sat + C_es offset - p_a| - |p_sat - p_a| + variation(nadir angle).
// `C_es` is that of satellite_axes; positions are ECEF of one instant, in m.
double satellite_antenna_range_m(const Eigen::Vector3d& offset_m, const AntennaGridView& variation,
                                 const Eigen::Vector3d& p_sat_e, const Eigen::Matrix3d& C_es,
                                 const Eigen::Vector3d& p_a_e);

// Returns the metres to ADD to the range to the antenna reference point to get the range to the
// phase centre:
//   -offset . u + variation(zenith angle, azimuth).
// `u_r` is the unit vector to the satellite in the antenna's axes: forward, right, down, which are
// north, east, down for a stationary antenna.
double receiver_antenna_range_m(const Eigen::Vector3d& offset_m, const AntennaGridView& variation,
                                const Eigen::Vector3d& u_r);

}  // namespace leonav
