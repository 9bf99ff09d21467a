// Antenna patterns written out, for tests.
#pragma once
#include <initializer_list>

#include "core/base/angle.h"
#include "core/gnss/propagation/antenna_model.h"

namespace leonav::test {

// `values_mm` at `step_deg` from zero, the same for every azimuth; offset in mm.
inline AntennaPattern satellite_pattern(SatelliteId id, char band, const Eigen::Vector3d& offset_mm,
                                        double step_deg = 1.0,
                                        std::initializer_list<double> values_mm = {}) {
  AntennaPattern pattern;
  pattern.satellite = id;
  pattern.band = band;
  pattern.offset_m = offset_mm * 1e-3;
  pattern.variation.angle_step = step_deg * kDegree;
  pattern.variation.angles = static_cast<int>(values_mm.size());
  pattern.variation.azimuths = values_mm.size() > 0 ? 1 : 0;
  for (const double value : values_mm) {
    pattern.variation.values.push_back(static_cast<float>(value * 1e-3));
  }
  return pattern;
}

inline AntennaPattern receiver_pattern(System system, char band, const Eigen::Vector3d& offset_mm,
                                       std::initializer_list<double> values_mm = {}) {
  AntennaPattern pattern = satellite_pattern({system, 0}, band, offset_mm, 5.0, values_mm);
  pattern.is_receiver = true;
  return pattern;
}

}  // namespace leonav::test
