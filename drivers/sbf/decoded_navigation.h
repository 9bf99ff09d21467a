// This unit reads the blocks with navigation data that the receiver has decoded: GPSNav (5891),
// GALNav (4002), BDSNav (4081) and GPSIon (5893). Source: mosaic-X5 Reference Guide, chapters of
// these names.
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "core/gnss/orbits/ephemeris.h"
#include "drivers/binary/ephemeris_status.h"

namespace leonav {

// Each function reads the payload of one block. Times of week are completed to the instants nearest
// to `near`, with which the weeks in the block must agree; angles come in semicircles. A set is
// taken as sent at `near`. What the elements are is not checked (is_sane). Precondition: `near` is
// set.
EphemerisStatus read_gpsnav(std::span<const std::uint8_t> payload, GpsTime near,
                            Ephemeris* ephemeris);
// A set of I/NAV or of F/NAV. Health bits that the receiver has not received count as healthy. A
// set without a group delay that its users need is refused as kNotSane.
EphemerisStatus read_galnav(std::span<const std::uint8_t> payload, GpsTime near,
                            Ephemeris* ephemeris);
// A delay of B2I that is not known counts as zero for satellites that do not send B2I (from C19
// on), and refuses the others as kNotSane.
EphemerisStatus read_bdsnav(std::span<const std::uint8_t> payload, GpsTime near,
                            Ephemeris* ephemeris);

// nullopt: shorter than its fields, or coefficients that are not finite or not known.
std::optional<KlobucharModel> read_gpsion(std::span<const std::uint8_t> payload);

}  // namespace leonav
