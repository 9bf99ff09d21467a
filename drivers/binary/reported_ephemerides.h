// ReportedEphemerides remembers what was last reported of each satellite, so that repetitions of a
// set are told from new ones.
#pragma once
#include <array>
#include <cstddef>

#include "core/gnss/orbits/ephemeris.h"

namespace leonav {

// It holds one set per satellite and navigation message.
class ReportedEphemerides {
 public:
  // Returns whether the set differs from the last one that was given for its satellite and message,
  // and remembers it. Two sets with the same contents are the same, whenever they were sent.
  // Precondition: the satellite's number is below kSatellites, which every GPS, Galileo and BeiDou
  // satellite's is.
  bool is_new(const Ephemeris& ephemeris);

  static constexpr std::size_t kSatellites = 64;

 private:
  std::array<std::array<Ephemeris, kSatellites>, kNavigationMessages> last_;
};

}  // namespace leonav
