// This unit reads the numbers of a record of a RINEX navigation file, and makes of those that all
// messages in Kepler form have in common elements of an orbit and a clock.
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/gnss/orbits/ephemeris.h"

namespace leonav {

// Fields that stand at the same place in every message in Kepler form, by RINEX 3.05 tables A6
// (GPS), A8 (Galileo), A14 (BeiDou), 2.11 table A4, and the records EPH of RINEX 4.01. What the
// spare names hold depends on the message.
enum KeplerField : std::size_t {
  kAf0,
  kAf1,
  kAf2,  //
  kIssueOrAxisRate,
  kCrs,
  kDeltaN,
  kM0,  //
  kCuc,
  kEccentricity,
  kCus,
  kSqrtA,  //
  kToe,
  kCic,
  kOmega0,
  kCis,  //
  kI0,
  kCrc,
  kOmega,
  kOmegaDot,  //
  kIDot,
  kKeplerFieldCount
};

// A field that is neither blank nor a complete number is this; a blank one is NaN.
inline constexpr double kDamagedField = std::numeric_limits<double>::infinity();

// Returns the number of fields in a record of this many lines: three behind the time in the first
// line, four in the others.
constexpr std::size_t field_count(std::size_t lines) { return 4 * lines - 1; }

// Reads field_count(lines.size()) numbers. RINEX 2 begins them a column earlier.
void read_fields(std::span<const std::string> lines, bool version_2, std::span<double> fields);

// Returns the time in a record's first line as it is written.
std::optional<GpsTime> record_time(std::string_view line, bool version_2);

// Returns whether the elements that no orbit can do without are numbers.
bool has_elements(std::span<const double> fields);

// Returns the number, or zero for one that is not there.
double or_zero(double value);
// Returns false if the rounded number does not fit; one that is not there is zero.
bool to_uint16(double value, std::uint16_t* result);

// Sets orbit and clock without their times.
void copy_elements(std::span<const double> fields, Ephemeris* ephemeris);

// Sets toc, toe and time of transmission (unset where it is not plausible). Times of week are the
// system's own, which precedes GPS time by `to_gps_s`. The week is the one nearest to the clock's
// reference time, because the week field is written modulo 1024, of toe or of the transmission,
// depending on the program that wrote the file.
void set_times(double toe_tow_s, double transmission_tow_s, GpsTime toc_as_written, double to_gps_s,
               Ephemeris* ephemeris);

// Returns the time of transmission alone, near `reference`; unset where it is not plausible.
GpsTime transmission_near(double tow_s, GpsTime reference);

}  // namespace leonav
