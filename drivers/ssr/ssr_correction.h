// This header defines corrections to broadcast orbits and clocks and biases of signals, as state
// space representation (SSR) messages give them. Source: RTCM 10403.3, 3.5.12; IGS SSR v1.00;
// Galileo HAS SIS ICD 1.0; BDS-SIS-ICD-PPP-B2b-1.0.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// What a message holds for each of its satellites.
enum class SsrKind : std::uint8_t {
  kOrbit = 0,
  kClock,
  kOrbitAndClock,
  kCodeBias,
  kPhaseBias,
  kAccuracy,
  kHighRateClock,
};

// Who defines a message. It decides which broadcast message is corrected, and what its issue is.
enum class SsrService : std::uint8_t {
  kRtcm = 0,
  kIgs,         // 4076
  kGalileoHas,  // E6-B
  kBeidouB2b,   // PPP-B2b
};

// Axes of an orbit's correction; across is r x v of the broadcast message for both.
enum class OrbitAxes : std::uint8_t {
  kAlongVelocity = 0,  // along is v, radial = along x across
  kRadial,             // radial is r, along = across x radial
};

// The values along radius, track and cross track are to be subtracted from the broadcast position,
// as X = X_broadcast - [r a c] delta.
struct SsrOrbit {
  std::uint16_t issue = 0;  // of the broadcast set that it corrects: IODE, IODnav, BeiDou's own
  // BeiDou in RTCM only: reference time of that set in units of 8 s, modulo 1024.
  std::optional<std::uint16_t> beidou_toe;
  Eigen::Vector3d delta_rac_m{0, 0, 0};     // radial, along, across
  Eigen::Vector3d delta_rate_rac{0, 0, 0};  // m/s
  OrbitAxes axes = OrbitAxes::kAlongVelocity;
  // B2b only: IOD Corr, which the satellite's clock must share.
  std::optional<std::uint8_t> correction_issue = std::nullopt;
};

// The polynomial, in metres, is to be added to the broadcast clock times the speed of light:
// c0 + c1 t + c2 t^2, with t from the message's time plus half its update interval, or from its
// time alone where the interval is the shortest one of a second.
struct SsrClock {
  double c0_m = 0.0, c1 = 0.0, c2 = 0.0;                        // m, m/s, m/s^2
  std::optional<std::uint8_t> correction_issue = std::nullopt;  // as of SsrOrbit
};

// The bias of a signal's code is to be added to its pseudorange, that of its phase to the carrier.
struct SsrBias {
  SignalCode code;
  double bias_m = 0.0;
  // Of a phase only.
  bool is_integer = false;           // the ambiguity of the corrected carrier is a whole number
  std::uint8_t wide_lane = 0;        // DF484, IDF030 as sent; 0: no whole wide lane
  std::uint8_t discontinuities = 0;  // counts modulo 16; of HAS modulo 4
};

// What a message says of one satellite; empty: not in this kind of message.
struct SsrSatellite {
  SatelliteId satellite;
  std::optional<SsrOrbit> orbit;
  std::optional<SsrClock> clock;
  // The message says that there is none: what was sent before ends.
  bool orbit_ends = false, clock_ends = false;
  std::optional<double> high_rate_clock_m;     // to be added to the clock's polynomial
  std::optional<std::uint8_t> accuracy_index;  // DF389, IDF034: class and value, 3 bits each
  std::vector<SsrBias> code_biases, phase_biases;
  double yaw_rad = 0.0, yaw_rate = 0.0;  // rad, rad/s; with phase biases
};

// One message.
struct SsrMessage {
  SsrKind kind = SsrKind::kOrbit;
  System system = System::kGps;
  SsrService service = SsrService::kRtcm;
  GpsTime time;                      // epoch of the corrections
  double update_interval_s = 0.0;    // of HAS and B2b there is none
  std::optional<double> validity_s;  // the corrections hold for so long after `time`
  // Which point of a satellite the corrected orbit is of; unset where no message says it.
  std::optional<bool> at_antenna;
  bool more_follow = false;
  bool is_regional_frame = false;  // orbit only: the frame is not the ITRF
  // IOD SSR, of HAS the IOD Set ID: orbits and clocks with the same one go together.
  std::uint8_t issue = 0;
  std::uint16_t provider = 0;                                              // of HAS and B2b 0
  std::uint8_t solution = 0;                                               // of HAS the Mask ID
  bool dispersive_is_consistent = false, wide_lane_is_consistent = false;  // phase biases only
  std::vector<SsrSatellite> satellites;
};

}  // namespace leonav
