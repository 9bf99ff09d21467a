// What lengthens a signal's path besides the atmosphere: gravity, tides, the antennas.
#pragma once
#include <Eigen/Core>
#include <cstdint>

#include "core/gnss/code_correction.h"

namespace leonav {

// Sum of the gravitational delay and of what the tide brings the antenna away from the satellite,
// m.
double path_delay_m(const DelayContext& context, const Eigen::Vector3d& p_a_e,
                    const SatelliteInView& satellite);

// Cycles of wind-up, going on from `previous`.
double wind_up_cycles(const DelayContext& context, const SatelliteInView& satellite,
                      double previous);

// By how much a range between phase centres is longer than one between the satellite's centre of
// mass and the receiver antenna's reference point; `second` empty: one frequency. Broadcast orbits
// are of the satellite's phase centre already.
struct AntennaCorrection {
  double range_m = 0.0;
  bool known = true;  // false: the satellite's antenna is not modelled, though its orbit needs it
  std::uint32_t issue = 0;  // of the patterns in it: another one, other patterns
};
AntennaCorrection antenna_range(const DelayContext& context, const SatelliteInView& satellite,
                                SignalCode first, SignalCode second);

}  // namespace leonav
