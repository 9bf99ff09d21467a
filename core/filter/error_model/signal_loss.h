// SignalLoss tells by how much weaker a satellite's signal is than it has been.
#pragma once
#include <array>
#include <cstddef>
#include <optional>

#include "core/base/gps_time.h"
#include "core/gnss/measurement/measurement.h"
#include "core/gnss/orbits/ephemeris_store.h"

namespace leonav {

// A signal that arrives only by a reflection, or bent around an edge, is weaker than the direct one
// of the same satellite was. The reference is the highest C/N0 of the satellite, less 0.3 dB for
// every minute since, because its elevation changes. Distance and elevation of a satellite in low
// orbit change within seconds: there the reference is the highest C/N0 of all of these satellites
// at about the same elevation, in steps of five degrees.
class SignalLoss {
 public:
  SignalLoss() { reset(); }
  void reset();
  // Takes the C/N0 of the satellites of an epoch. The same epoch may be given several times.
  void add(const MeasurementEpoch& epoch);
  // Returns the loss of a satellite of the last epoch, dB, not below 0. It is 0 without a C/N0.
  double loss_db(const SatelliteInView& satellite) const;

 private:
  static constexpr std::size_t kElevations = 18;
  struct Reference {
    double cn0_dbhz = 0.0;
    GpsTime time;
  };
  // Returns the place of a satellite's reference; nothing without C/N0, in low orbit elevation.
  static std::optional<std::size_t> place_of(const SatelliteInView& satellite);

  // Those of satellites, then those of elevations of low orbits.
  std::array<Reference, kMaxEphemerisSatellites + kElevations> references_;
};

}  // namespace leonav
