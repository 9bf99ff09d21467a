// CarrierCycles is what a corrected carrier keeps of its whole cycles.
#pragma once
#include <array>

#include "core/gnss/measurement/geometry_free.h"

namespace leonav {

// Two arcs of a satellite's carrier differ by whole cycles of each of its signals. In the
// measurement that is gamma[0] wavelength_m[0] n1 + gamma[1] wavelength_m[1] n2, and in the
// geometry-free combination, first minus second carrier, wavelength_m[0] n1 - wavelength_m[1] n2.
struct CarrierCycles {
  std::array<double, 2> wavelength_m{};  // the second is 0 on one frequency
  std::array<double, 2> gamma{1.0, 0.0};
  double geometry_free_m = 0.0;  // of a pair, without the wind-up
  GeometryFreeNoise geometry_free_noise;
  // Half cycles that were repaired since the arc began; the carriers contain them.
  std::array<double, 2> repaired_m{};
  bool half_cycle_unresolved = false;  // the carrier may still jump by half a cycle

  bool is_pair() const { return wavelength_m[1] > 0.0; }
  // Returns what the half cycles repaired are in the measurement, m.
  double repaired_measurement_m() const {
    return gamma[0] * repaired_m[0] + gamma[1] * repaired_m[1];
  }
  double repaired_geometry_free_m() const { return repaired_m[0] - repaired_m[1]; }
};

}  // namespace leonav
