// This header defines broadcast ephemerides in Kepler form: GPS LNAV, Galileo I/NAV and F/NAV,
// BeiDou D1, D2 and B-CNAV1.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"

namespace leonav {

// The values are on the wire: append only.
enum class NavigationMessage : std::uint8_t {
  kGpsLnav = 0,
  kGalileoInav = 1,
  kGalileoFnav = 2,
  kBeidouD1 = 3,
  kBeidouD2 = 4,
  kBeidouCnav1 = 5,  // is_for_corrections_alone(); on no wire
};
inline constexpr std::size_t kNavigationMessages = 6;

// One set of broadcast elements, in SI units and radians (semicircles of the messages are already
// multiplied by pi). All times are GPS time (BeiDou's are already moved by 14 s). Symbols are those
// of IS-GPS-200, table 20-III.
struct Ephemeris {
  SatelliteId satellite;
  NavigationMessage message = NavigationMessage::kGpsLnav;
  GpsTime toe;                    // reference time of the orbit
  GpsTime toc;                    // reference time of the clock
  GpsTime transmission_time;      // when the set was sent; unset if unknown
  std::uint16_t issue = 0;        // GPS IODE, Galileo IODnav, BeiDou AODE, of B-CNAV1 IODE
  std::uint16_t issue_clock = 0;  // GPS IODC, BeiDou AODC, of B-CNAV1 IODC
  std::uint16_t health = 0;       // 0 is healthy; otherwise the raw bits as in RINEX
  double accuracy_m = 0.0;        // user range accuracy / SISA, 1 sigma; negative: no prediction

  double sqrt_a = 0.0;  // sqrt(m)
  double eccentricity = 0.0;
  double m0 = 0.0;              // rad
  double delta_n = 0.0;         // rad/s
  double omega0 = 0.0;          // rad, longitude of ascending node at weekly epoch
  double omega_dot = 0.0;       // rad/s
  double i0 = 0.0;              // rad
  double i_dot = 0.0;           // rad/s
  double omega = 0.0;           // rad, argument of perigee
  double cuc = 0.0, cus = 0.0;  // rad
  double crc = 0.0, crs = 0.0;  // m
  double cic = 0.0, cis = 0.0;  // rad
  // Rates that only B-CNAV1 and a LEO satellite's message have; as in CNAV (IS-GPS-200 table 30-I,
  // BDS-SIS-ICD-B1C table 7-8).
  double a_dot = 0.0;        // m/s, of the semi-major axis
  double delta_n_dot = 0.0;  // rad/s^2, of delta_n

  double af0 = 0.0, af1 = 0.0, af2 = 0.0;  // s, s/s, s/s^2

  // Group delays in seconds. GPS: [0] TGD. Galileo: [0] BGD E5a/E1, [1] BGD E5b/E1.
  // BeiDou: [0] TGD1 (B1I), [1] TGD2 (B2I).
  std::array<double, 2> group_delay_s = {0.0, 0.0};
};

// Returns whether elements serve a correction service alone, which refers to them. Those of B-CNAV1
// come without the group delays of B1I and B2I, without which most users of the clock are off by
// metres, and without health; D1 gives all of it.
inline bool is_for_corrections_alone(const Ephemeris& ephemeris) {
  return ephemeris.message == NavigationMessage::kBeidouCnav1;
}

// Klobuchar coefficients as broadcast by GPS (IS-GPS-200 20.3.3.5.2.5).
struct KlobucharModel {
  std::array<double, 4> alpha = {0, 0, 0, 0};  // s, s/semicircle, ...
  std::array<double, 4> beta = {0, 0, 0, 0};
  bool valid = false;

  friend bool operator==(const KlobucharModel&, const KlobucharModel&) = default;
};

}  // namespace leonav
