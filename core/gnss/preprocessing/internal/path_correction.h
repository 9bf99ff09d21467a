// This unit computes what lengthens a signal's path beside the atmosphere: gravity, tides, and the
// antennas.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/gnss/preprocessing/internal/code_correction.h"

namespace leonav {

// Returns the sum of the gravitational delay and of the tidal displacement of the antenna away from
// the satellite, in m.
double path_delay_m(const DelayContext& context, const Eigen::Vector3d& p_a_e,
                    const SatelliteInView& satellite);

// Returns the wind-up in cycles, continued from `previous`.
double wind_up_cycles(const DelayContext& context, const SatelliteInView& satellite,
                      double previous);

// Correction of a range between phase centres: by how much it is longer than the range between the
// satellite's centre of mass and the receiver antenna's reference point. With `second` unset it
// holds for one frequency. Broadcast orbits already refer to the satellite's phase centre.
struct AntennaCorrection {
  double range_m = 0.0;
  bool known = true;  // false: the satellite's antenna is not modelled, though its orbit needs it
  std::uint32_t issue = 0;  // identity of its patterns; a new one means other patterns
};
// Computes the correction for the antenna patterns of both ends.
AntennaCorrection antenna_range(const DelayContext& context, const SatelliteInView& satellite,
                                SignalCode first, SignalCode second);

}  // namespace leonav
