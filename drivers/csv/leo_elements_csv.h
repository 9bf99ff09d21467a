// This unit reads and writes leo_elements.csv: broadcast elements of LEO satellites, a row for each
// satellite and reference time.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"
#include "drivers/csv/csv_rows.h"

namespace leonav {

// Symbols and constants are those of leo_ephemeris_t (lcmtypes), units are in the names. `gps_week`
// is that of `toe_tow_s`; the other times of week are those nearest to it. An element is used from
// `transmission_tow_s` on.
inline constexpr std::string_view kLeoElementsColumns =
    "satellite,gps_week,toe_tow_s,transmission_tow_s,sqrt_a_sqrt_m,eccentricity,m0_rad,"
    "delta_n_rad_s,omega0_rad,omega_dot_rad_s,i0_rad,i_dot_rad_s,omega_rad,cuc_rad,cus_rad,crc_m,"
    "crs_m,cic_rad,cis_rad,af0_s,af1_s_s";
// A file may leave these out: toc = toe, no rates, issue 0, healthy, no statement of accuracy.
inline constexpr std::string_view kLeoElementsOptionalColumns =
    "a_dot_m_s,delta_n_dot_rad_s2,af2_s_s2,toc_tow_s,issue,issue_clock,health,accuracy_m";

// Contents of a file, in its order. All are sane.
struct LeoElementsCsv {
  std::vector<Ephemeris> ephemerides;
  CsvReport report;
};

// Reads a whole file. A row that does not parse, or whose elements no LEO satellite can have, is
// skipped and reported. Throws FileError where a column is missing, or no row is usable.
LeoElementsCsv read_leo_elements_csv(const std::string& path);

// Writes all columns; numbers are read back as the same bits. Those that are not of LEO satellites
// are left out. Throws FileError.
void write_leo_elements_csv(const std::string& path, std::span<const Ephemeris> ephemerides);

}  // namespace leonav
