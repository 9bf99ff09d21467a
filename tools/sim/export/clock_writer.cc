#include "tools/sim/export/clock_writer.h"

#include <cmath>
#include <set>
#include <vector>

#include "tools/sim/export/text_file.h"

namespace leonav::sim {
namespace {

void write_header(const std::set<SatelliteId>& satellites, TextFile* file) {
  file->labelled("     3.00           C                   M", "RINEX VERSION / TYPE");
  file->labelled("leonav-sim", "PGM / RUN BY / DATE");
  file->labelled("   GPS", "TIME SYSTEM ID");
  file->labelled("     1    AS", "# / TYPES OF DATA");
  file->labelled("LEO leonav-sim", "ANALYSIS CENTER");
  file->labelled(formatted("%6zu", satellites.size()), "# OF SOLN SATS");
  std::string line;
  for (const SatelliteId satellite : satellites) {
    line += to_string(satellite) + " ";
    if (line.size() < 60) continue;
    file->labelled(line, "PRN LIST");
    line.clear();
  }
  if (!line.empty()) file->labelled(line, "PRN LIST");
  file->labelled("", "END OF HEADER");
}

}  // namespace

void write_rinex_clock(const std::string& path, std::span<const OrbitEpoch> epochs) {
  std::set<SatelliteId> satellites;
  for (const OrbitEpoch& epoch : epochs) {
    for (const PreciseState& state : epoch.states) satellites.insert(state.satellite);
  }
  TextFile file(path);
  write_header(satellites, &file);
  for (const OrbitEpoch& epoch : epochs) {
    const CalendarTime c = rounded_calendar(epoch.time, 6);
    const std::string time = formatted("%4d %02d %02d %02d %02d %9.6f", c.year, c.month, c.day,
                                       c.hour, c.minute, c.second);
    for (const PreciseState& state : epoch.states) {
      if (!std::isfinite(state.clock_s)) continue;
      file.line("AS " + to_string(state.satellite) + "  " + time +
                formatted("  1   %19.12E", state.clock_s));
    }
  }
  file.close();
}

}  // namespace leonav::sim
