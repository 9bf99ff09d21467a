// This unit applies corrections of orbit and clock to broadcast elements.
#pragma once
#include "core/gnss/orbits/corrected_state.h"
#include "core/gnss/orbits/ephemeris.h"
#include "drivers/ssr/ssr_correction.h"

namespace leonav {

// A satellite's corrections with the instants that their polynomials are counted from.
struct OrbitAndClock {
  SsrOrbit orbit;
  GpsTime orbit_reference;
  SsrClock clock;
  GpsTime clock_reference;
  double high_rate_clock_m = 0.0;  // 0: none
};

// Returns the instant that the polynomials of a message are counted from: its time and half its
// update interval, of the shortest interval (1 s) its time alone. Source: RTCM 10403.3, DF391; IGS
// SSR v1.00, IDF004.
GpsTime reference_time(const SsrMessage& message);

// Computes the state at `time`. With position r and velocity v of the broadcast message (ECEF),
//   along = v/|v|, across = r x v/|r x v|, radial = along x across, or
//   radial = r/|r|, across = r x v/|r x v|, along = across x radial by the orbit's axes,
//   p = r - [radial along across] (delta + rate (t - t_orbit))
//   clock = broadcast clock with its relativistic term + (c0 + c1 s + c2 s^2 + high rate)/c,
//   s = t - t_clock.
// Sigma, ages and the point of the satellite are the caller's. Source: RTCM 10403.3, 3.5.12.3; IGS
// SSR v1.00, 7; Galileo HAS SIS ICD 1.0, 7; BDS-SIS-ICD-PPP-B2b-1.0, 7.
CorrectedState apply(const OrbitAndClock& corrections, const Ephemeris& broadcast, GpsTime time);

// Returns whether an orbit's correction refers to these elements, by the issue that a message of
// the service gives: the lowest eight bits of GPS' IODE, of Galileo's IODnav as many as were sent,
// of BeiDou toe in units of 8 s modulo 1024 (RTCM) or of 720 s modulo 240 (IGS). HAS and B2b refer
// to Galileo's I/NAV alone, and B2b to BeiDou's B-CNAV1 alone, by the lowest eight bits of its
// IODC, which are the IODE. RTCM and the IGS refer to D1 and D2.
bool is_corrected_by(const Ephemeris& broadcast, const SsrOrbit& orbit, SsrService service);

}  // namespace leonav
