// BandPlan gives the carrier frequency of every band: those of GPS, Galileo and BeiDou are fixed by
// their interface documents, those of LEO satellites are configured.
#pragma once
#include <array>
#include <cstddef>

#include "core/gnss/signals/satellite.h"

namespace leonav {

// The LEO satellites of a configuration share one plan. It is a value, part of GnssConfig: whoever
// converts cycles or combines frequencies gets it from there.
class BandPlan {
 public:
  // The bands of LEO satellites are '1' to '9', as in RINEX.
  static constexpr char kFirstBand = '1', kLastBand = '9';
  static constexpr std::size_t kBands = 9;
  // LEO carriers are between these, Hz: L, S and C band.
  static constexpr double kLowest_hz = 1e9, kHighest_hz = 8e9;

  // Makes the default plan: LEO satellites transmit on GPS L1 and L2, as bands 1 and 2.
  BandPlan();

  // Sets a band of the LEO satellites; 0 Hz: they do not have it. The caller checks the range.
  void set_leo(char band, double frequency_hz);

  // Returns the carrier frequency in Hz, or 0 for a band that the system does not have.
  double frequency_hz(System system, char band) const;
  // Returns the carrier wavelength in m, or 0.
  double wavelength_m(System system, char band) const;

  bool operator==(const BandPlan&) const = default;

 private:
  std::array<double, kBands> leo_hz_{};  // 0: no such band
};

// Returns whether the system may have this band, whatever the plan: any of '1' to '9' of a LEO
// satellite. Inputs are checked by it where no configuration is at hand.
bool is_band_of(System system, char band);

}  // namespace leonav
