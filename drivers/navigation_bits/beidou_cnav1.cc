#include "drivers/navigation_bits/beidou_cnav1.h"

#include <cmath>

#include "core/base/angle.h"
#include "drivers/binary/beidou_time.h"
#include "drivers/binary/bit_field.h"

namespace leonav {
namespace {

constexpr std::int64_t kHour_s = 3600, kReferenceUnit_s = 300;  // of toe and toc
constexpr std::uint32_t kHoursOfWeek = 168;

// A number of 33 bits in two's complement, or without a sign, times 2^power.
double take_33(BitReader* bits, bool is_signed, int power) {
  const double high = is_signed ? bits->take_signed(17) : static_cast<double>(bits->take(17));
  return std::ldexp(high * 65536.0 + bits->take(16), power);
}

// Semi-major axis in metres that the message's own is counted from, by the type of the orbit; zero
// for types that are not defined.
double reference_axis_m(std::uint32_t orbit_type) {
  constexpr std::uint32_t kGeostationary = 1, kInclined = 2, kMedium = 3;
  if (orbit_type == kMedium) return 27'906'100.0;
  return orbit_type == kGeostationary || orbit_type == kInclined ? 42'162'200.0 : 0.0;
}

GpsTime reference_time(BitReader* bits, GpsTime near) {
  return nearest_beidou_instant(std::int64_t{bits->take(11)} * kReferenceUnit_s, near);
}

}  // namespace

SubframeStatus read_bcnav1_elements(std::span<const std::uint8_t> bits,
                                    const SubframeOrigin& origin, Ephemeris* ephemeris) {
  Ephemeris& e = *ephemeris;
  e = {};
  e.satellite = origin.satellite;
  e.message = NavigationMessage::kBeidouCnav1;
  e.transmission_time = origin.now;

  BitReader r(bits);
  const auto week = static_cast<int>(r.take(13));
  const std::uint32_t hour = r.take(8);
  const GpsTime of_hour = nearest_beidou_instant(std::int64_t{hour} * kHour_s, origin.now);
  if (hour >= kHoursOfWeek || !beidou_week_agrees(week, of_hour)) return SubframeStatus::kBadWeek;
  e.issue_clock = static_cast<std::uint16_t>(r.take(10));
  e.issue = static_cast<std::uint16_t>(r.take(8));
  if ((e.issue_clock & 0xFF) != e.issue) return SubframeStatus::kBadParity;

  e.toe = reference_time(&r, origin.now);
  const double axis_m = reference_axis_m(r.take(2));
  if (axis_m == 0.0) return SubframeStatus::kBadParity;
  e.sqrt_a = std::sqrt(axis_m + r.scaled_signed(26, -9));
  e.a_dot = r.scaled_signed(25, -21);
  e.delta_n = r.scaled_signed(17, -44) * kPi;
  e.delta_n_dot = r.scaled_signed(23, -57) * kPi;
  e.m0 = take_33(&r, true, -32) * kPi;
  e.eccentricity = take_33(&r, false, -34);
  e.omega = take_33(&r, true, -32) * kPi;
  e.omega0 = take_33(&r, true, -32) * kPi;
  e.i0 = take_33(&r, true, -32) * kPi;
  e.omega_dot = r.scaled_signed(19, -44) * kPi;
  e.i_dot = r.scaled_signed(15, -44) * kPi;
  e.cis = r.scaled_signed(16, -30);
  e.cic = r.scaled_signed(16, -30);
  e.crs = r.scaled_signed(24, -8);
  e.crc = r.scaled_signed(24, -8);
  e.cus = r.scaled_signed(21, -30);
  e.cuc = r.scaled_signed(21, -30);

  e.toc = reference_time(&r, origin.now);
  e.af0 = r.scaled_signed(25, -34);
  e.af1 = r.scaled_signed(22, -50);
  e.af2 = r.scaled_signed(11, -66);
  return SubframeStatus::kUsed;
}

}  // namespace leonav
