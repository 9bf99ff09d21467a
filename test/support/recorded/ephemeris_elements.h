// The orbit and clock elements of an ephemeris as numbers, for tests that compare all of them.
#pragma once
#include <array>

#include "core/gnss/orbits/ephemeris.h"

namespace leonav::test {

// Returns the Keplerian elements and their rates, corrections, clock and group delays, in SI units
// and radians.
inline std::array<double, 20> elements_of(const Ephemeris& e) {
  return {e.sqrt_a,
          e.eccentricity,
          e.m0,
          e.delta_n,
          e.omega0,
          e.omega_dot,
          e.i0,
          e.i_dot,
          e.omega,
          e.cuc,
          e.cus,
          e.crc,
          e.crs,
          e.cic,
          e.cis,
          e.af0,
          e.af1,
          e.af2,
          e.group_delay_s[0],
          e.group_delay_s[1]};
}

}  // namespace leonav::test
