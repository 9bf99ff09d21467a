#include "tools/sim/export/sp3_writer.h"

#include <cmath>
#include <set>
#include <vector>

#include "tools/sim/export/text_file.h"

namespace leonav::sim {
namespace {

constexpr std::size_t kNamesPerLine = 17;
constexpr std::size_t kFewestNameLines = 5;  // that readers of SP3-c expect
constexpr std::int64_t kUnixToMjd = 40587;   // the GPS epoch is 3657 days after that of Unix

std::string date(GpsTime time) {
  const CalendarTime c = rounded_calendar(time, 8);
  return formatted("%4d %2d %2d %2d %2d %11.8f", c.year, c.month, c.day, c.hour, c.minute,
                   c.second);
}

void write_names(const std::vector<SatelliteId>& satellites, TextFile* file) {
  const std::size_t lines =
      std::max(kFewestNameLines, (satellites.size() + kNamesPerLine - 1) / kNamesPerLine);
  for (const bool accuracies : {false, true}) {
    for (std::size_t l = 0; l < lines; ++l) {
      std::string line = accuracies ? "++       " : "+        ";
      if (!accuracies && l == 0) line = formatted("+  %3zu   ", satellites.size());
      for (std::size_t i = l * kNamesPerLine; i < (l + 1) * kNamesPerLine; ++i) {
        const bool there = !accuracies && i < satellites.size();
        line += there ? to_string(satellites[i]) : "  0";
      }
      file->line(line);
    }
  }
}

void write_header(std::span<const OrbitEpoch> epochs, const std::vector<SatelliteId>& satellites,
                  const std::string& comment, TextFile* file) {
  const GpsTime first = epochs.front().time;
  const double interval_s = epochs.size() > 1 ? seconds_between(epochs[1].time, first) : 0.0;
  file->line("#dP" + date(first) + formatted(" %7zu ORBIT IGb14 FIT LEON", epochs.size()));
  const std::int64_t days = first.nanoseconds() / (86'400 * kNanosecondsPerSecond);
  const double day_part =
      static_cast<double>(first.nanoseconds() % (86'400 * kNanosecondsPerSecond)) / 86'400e9;
  file->line(formatted("## %4d %15.8f %14.8f %5d %15.13f", first.week(), first.tow_s(), interval_s,
                       static_cast<int>(days + kUnixToMjd + 3657), day_part));
  write_names(satellites, file);
  file->line("%c M  cc GPS ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc");
  file->line("%c cc cc ccc ccc cccc cccc cccc cccc ccccc ccccc ccccc ccccc");
  file->line("%f  1.2500000  1.025000000  0.00000000000  0.000000000000000");
  file->line("%f  0.0000000  0.000000000  0.00000000000  0.000000000000000");
  for (int i = 0; i < 2; ++i) {
    file->line("%i    0    0    0    0      0      0      0      0         0");
  }
  file->line("/* " + comment);
  for (int i = 0; i < 3; ++i) file->line("/*");
}

void write_state(const PreciseState& state, TextFile* file) {
  const Eigen::Vector3d km = state.p_e * 1e-3;
  const double microseconds = std::isfinite(state.clock_s) ? state.clock_s * 1e6 : 999'999.999999;
  std::string line = "P" + to_string(state.satellite) +
                     formatted("%14.6f%14.6f%14.6f%14.6f", km.x(), km.y(), km.z(), microseconds);
  line.resize(80, ' ');
  if (state.clock_event) line[74] = 'E';
  if (state.clock_predicted) line[75] = 'P';
  if (state.maneuver) line[78] = 'M';
  if (state.orbit_predicted) line[79] = 'P';
  file->line(line);
}

}  // namespace

void write_sp3(const std::string& path, std::span<const OrbitEpoch> epochs,
               const std::string& comment) {
  std::set<SatelliteId> satellites;
  for (const OrbitEpoch& epoch : epochs) {
    for (const PreciseState& state : epoch.states) satellites.insert(state.satellite);
  }
  TextFile file(path);
  write_header(epochs, {satellites.begin(), satellites.end()}, comment, &file);
  for (const OrbitEpoch& epoch : epochs) {
    file.line("*  " + date(epoch.time));
    for (const PreciseState& state : epoch.states) write_state(state, &file);
  }
  file.line("EOF");
  file.close();
}

}  // namespace leonav::sim
