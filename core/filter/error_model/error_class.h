// ErrorClass sorts measurements by what their errors have in common.
#pragma once
#include <algorithm>
#include <cstddef>

#include "core/gnss/measurement/measurement.h"

namespace leonav {

inline constexpr std::size_t kElevationClasses = 4;
inline constexpr std::size_t kSignalClasses = 2;  // single frequency, ionosphere-free pair
inline constexpr std::size_t kMotionClasses = 2;  // moving, standing
inline constexpr std::size_t kLossClasses = 4;

// The class of one code or Doppler. Reflections come from below the roofs, so that elevation says
// most; systems differ in chip shape and orbits, pairs amplify what each signal has. A signal
// weaker than it was is bent or reflected.
struct ErrorClass {
  std::size_t observable = 0;  // Observable
  std::size_t system = 0;      // System
  std::size_t elevation = 0;   // below 20, 35, 50 degrees, above
  std::size_t signal = 0;
  std::size_t loss = 0;    // below 3, 6, 10 dB, above: SignalLoss
  std::size_t motion = 0;  // 1: the vehicle stands, and so does what reflects
};

// Returns the class of a measurement; `satellite` is the one that it is of, `loss_db` what its
// signal has lost.
inline ErrorClass error_class(const Measurement& measurement, const SatelliteInView& satellite,
                              double loss_db, bool standing) {
  constexpr double kFirst = 0.349, kStep = 0.262;  // rad: 20 and 15 degrees
  const double step = (satellite.elevation - kFirst) / kStep + 1.0;
  return {static_cast<std::size_t>(measurement.observable),
          index_of(satellite.satellite.system),
          static_cast<std::size_t>(std::clamp(step, 0.0, kElevationClasses - 1.0)),
          measurement.second_code == SignalCode() ? std::size_t{0} : std::size_t{1},
          loss_db < 3.0    ? std::size_t{0}
          : loss_db < 6.0  ? std::size_t{1}
          : loss_db < 10.0 ? std::size_t{2}
                           : std::size_t{3},
          standing ? std::size_t{1} : std::size_t{0}};
}

}  // namespace leonav
