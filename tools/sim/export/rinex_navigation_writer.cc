#include "tools/sim/export/rinex_navigation_writer.h"

#include <vector>

#include "tools/sim/export/text_file.h"

namespace leonav::sim {
namespace {

// Fields whose meaning depends on the system.
struct SystemFields {
  double sources = 0.0, week = 0.0, delay2_or_iodc = 0.0, fit_or_aodc = 0.0;
};

std::int64_t to_own_time_ns(const Ephemeris& e) {
  const bool beidou = e.satellite.system == System::kBeidou;
  return beidou ? kBeidouMinusGpsSeconds * kNanosecondsPerSecond : 0;
}
double own_week(const Ephemeris& e) { return e.toe.plus_nanoseconds(to_own_time_ns(e)).week(); }

SystemFields system_fields(const Ephemeris& e) {
  switch (e.satellite.system) {
    case System::kGalileo: {
      // Bits 0 and 2 and 9: I/NAV, clock for E5b; bits 1 and 8: F/NAV, clock for E5a.
      const bool fnav = e.message == NavigationMessage::kGalileoFnav;
      return {fnav ? 258.0 : 517.0, own_week(e), e.group_delay_s[1], 0.0};
    }
    case System::kBeidou:
      return {0.0, own_week(e) - kBeidouWeekZeroInGpsWeeks, e.group_delay_s[1],
              static_cast<double>(e.issue_clock)};
    case System::kGps:
    case System::kLeo:
      break;
  }
  return {1.0, own_week(e), static_cast<double>(e.issue_clock), 4.0};
}

void write_record(const Ephemeris& e, TextFile* file) {
  const std::int64_t to_own = to_own_time_ns(e);
  const CalendarTime c = rounded_calendar(e.toc.plus_nanoseconds(to_own), 0);
  const GpsTime sent = e.transmission_time.is_set() ? e.transmission_time : e.toe;
  const SystemFields own = system_fields(e);
  const double accuracy = e.accuracy_m, health = e.health, issue = e.issue;
  const std::vector<double> numbers = {issue,
                                       e.crs,
                                       e.delta_n,
                                       e.m0,
                                       e.cuc,
                                       e.eccentricity,
                                       e.cus,
                                       e.sqrt_a,
                                       e.toe.plus_nanoseconds(to_own).tow_s(),
                                       e.cic,
                                       e.omega0,
                                       e.cis,
                                       e.i0,
                                       e.crc,
                                       e.omega,
                                       e.omega_dot,
                                       e.i_dot,
                                       own.sources,
                                       own.week,
                                       0.0,
                                       accuracy,
                                       health,
                                       e.group_delay_s[0],
                                       own.delay2_or_iodc,
                                       sent.plus_nanoseconds(to_own).tow_s(),
                                       own.fit_or_aodc};
  file->line(to_string(e.satellite) +
             formatted(" %04d %02d %02d %02d %02d %02d%19.12E%19.12E%19.12E", c.year, c.month,
                       c.day, c.hour, c.minute, static_cast<int>(c.second), e.af0, e.af1, e.af2));
  std::string line = "    ";
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    line += formatted("%19.12E", numbers[i]);
    if (i % 4 != 3 && i + 1 != numbers.size()) continue;
    file->line(line);
    line = "    ";
  }
}

}  // namespace

void write_rinex_navigation(const std::string& path, std::span<const Ephemeris> ephemerides) {
  TextFile file(path);
  file.labelled("     3.04           N: GNSS NAV DATA    M: MIXED", "RINEX VERSION / TYPE");
  file.labelled("leonav-sim", "PGM / RUN BY / DATE");
  file.labelled("    18", "LEAP SECONDS");
  file.labelled("", "END OF HEADER");
  for (const Ephemeris& ephemeris : ephemerides) {
    if (ephemeris.satellite.system != System::kLeo) write_record(ephemeris, &file);
  }
  file.close();
}

}  // namespace leonav::sim
