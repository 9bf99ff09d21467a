// This unit reads the logs with broadcast ephemerides, RAWEPHEM (41), GPSEPHEM (7),
// GALINAVEPHEMERIS (1309), GALFNAVEPHEMERIS (1310), BDSEPHEMERIS (1696), and IONUTC (8). Source:
// OEM7 manual, chapters of these names. OEM6 has GALEPHEMERIS (1122) in place of the two of
// Galileo. Source: OEM6 manual, chapter of this name.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "core/gnss/orbits/ephemeris.h"
#include "drivers/binary/ephemeris_status.h"

namespace leonav {

// Each function reads the payload of one log. Times of week are completed to the instants nearest
// to `near`, with which a week in the log must agree. Precondition: `near` is set.
EphemerisStatus read_rawephem(std::span<const std::uint8_t> payload, GpsTime near,
                              Ephemeris* ephemeris);
EphemerisStatus read_gpsephem(std::span<const std::uint8_t> payload, GpsTime near,
                              Ephemeris* ephemeris);
EphemerisStatus read_bdsephemeris(std::span<const std::uint8_t> payload, GpsTime near,
                                  Ephemeris* ephemeris);

// The length must be that of the manual's table: early firmware had other fields under the same
// numbers, in 188 and 180 bytes.
EphemerisStatus read_galinavephemeris(std::span<const std::uint8_t> payload, GpsTime near,
                                      Ephemeris* ephemeris);
EphemerisStatus read_galfnavephemeris(std::span<const std::uint8_t> payload, GpsTime near,
                                      Ephemeris* ephemeris);

// GALEPHEMERIS holds the set of I/NAV, that of F/NAV, or both, with the orbit in common.
struct GalileoSets {
  std::optional<Ephemeris> inav, fnav;
};
EphemerisStatus read_galephemeris(std::span<const std::uint8_t> payload, GpsTime near,
                                  GalileoSets* sets);

// nullopt: shorter than its fields, or coefficients that are not finite.
std::optional<KlobucharModel> read_ionutc(std::span<const std::uint8_t> payload);

}  // namespace leonav
