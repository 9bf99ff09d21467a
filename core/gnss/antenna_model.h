// Where a signal really leaves and enters an antenna: offset of the mean phase centre and variation
// with direction, for one band, as ANTEX files have them.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <optional>

#include "core/capacity.h"
#include "core/gnss/satellite.h"
#include "core/time/gps_time.h"

namespace leonav {

// Variation in m at equidistant angles from the antenna's boresight (zenith angle at a receiver,
// nadir angle at a satellite) and azimuths. Values lie row by row, one row per azimuth; one row:
// the same for every azimuth. With more, rows are at 0, step, ... 2 pi, first and last for the same
// direction.
struct AntennaGrid {
  double first_angle = 0.0;  // rad
  double angle_step = 0.0;   // rad; 0 only with a single angle
  int angles = 0;            // per row; 0: no variation
  int azimuths = 0;          // rows: 0 (no variation), 1, or at least 3
  boost::container::static_vector<float, kMaxAntennaValues> values;
};

// The same without owning the values, which a catalogue keeps in less space.
struct AntennaGridView {
  double first_angle = 0.0, angle_step = 0.0;
  int angles = 0, azimuths = 0;
  const float* values = nullptr;  // angles * azimuths
};
AntennaGridView view(const AntennaGrid& grid);

struct AntennaPattern {
  bool is_receiver = false;
  // Whose antenna. Of a receiver antenna only the system counts (number 0): whose signals.
  SatelliteId satellite;
  char band = 0;        // '1'..'9' as in signal.h
  GpsTime valid_from;   // unset: always
  GpsTime valid_until;  // unset: for good
  // Satellite: from the centre of mass along the body's X, Y, Z (satellite_axes). Receiver: from
  // the antenna reference point to north, east, up of the antenna. m.
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  AntennaGrid variation;
};

// Finite, offset below 10 m, variation below 1 m, counts that fit each other, a band the system
// has.
bool is_sane(const AntennaPattern& pattern);

// Sane, and of a satellite no more than AntennaCatalog keeps: one row, kMaxNadirValues angles.
bool is_storable(const AntennaPattern& pattern);

// Variation in m, bilinear; beyond the grid's angles the value at its end. `azimuth` in rad, any
// turn: clockwise from north seen from above (receiver), from body Y towards X (satellite).
double variation_m(const AntennaGridView& grid, double angle, double azimuth);

// Metres to ADD to the range from the centre of mass to get the range from the phase centre:
//   |p_sat + C_es offset - p_a| - |p_sat - p_a| + variation(nadir angle).
// `C_es` from satellite_axes; positions ECEF of one instant, m.
double satellite_antenna_range_m(const Eigen::Vector3d& offset_m, const AntennaGridView& variation,
                                 const Eigen::Vector3d& p_sat_e, const Eigen::Matrix3d& C_es,
                                 const Eigen::Vector3d& p_a_e);

// Metres to ADD to the range to the antenna reference point to get the range to the phase centre:
//   -offset . u + variation(zenith angle, azimuth).
// `u_r`: unit vector to the satellite in the antenna's axes, forward-right-down (north, east, down
// for one that stands).
double receiver_antenna_range_m(const Eigen::Vector3d& offset_m, const AntennaGridView& variation,
                                const Eigen::Vector3d& u_r);

}  // namespace leonav
