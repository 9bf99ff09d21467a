#include "tools/sim/export/antex_writer.h"

#include "core/base/angle.h"
#include "tools/sim/export/text_file.h"

namespace leonav::sim {
namespace {

char letter_of(System system) {
  constexpr std::array<char, kSystemCount> letters = {'G', 'E', 'C', 'L'};
  return letters[index_of(system)];
}

bool same_antenna(const AntennaPattern& a, const AntennaPattern& b) {
  return a.is_receiver == b.is_receiver && (a.is_receiver || a.satellite == b.satellite);
}

double mean_at(const AntennaGrid& grid, int angle) {
  double sum = 0.0;
  for (int row = 0; row < grid.azimuths; ++row) {
    sum += grid.values[static_cast<std::size_t>(row * grid.angles + angle)];
  }
  return sum / grid.azimuths;
}

// A pattern without variations is written as zeros at two angles, because readers expect a grid.
void write_band(const AntennaPattern& pattern, TextFile* file) {
  const std::string name = formatted("   %c0%c", letter_of(pattern.satellite.system), pattern.band);
  file->labelled(name, "START OF FREQUENCY");
  const Eigen::Vector3d mm = pattern.offset_m * 1e3;
  file->labelled(formatted("%10.2f%10.2f%10.2f", mm.x(), mm.y(), mm.z()), "NORTH / EAST / UP");
  const AntennaGrid& grid = pattern.variation;
  std::string values = "   NOAZI";
  if (grid.azimuths == 0) values += formatted("%8.2f%8.2f", 0.0, 0.0);
  for (int i = 0; grid.azimuths > 0 && i < grid.angles; ++i) {
    values += formatted("%8.2f", 1e3 * mean_at(grid, i));
  }
  file->line(values);
  file->labelled(name, "END OF FREQUENCY");
}

void write_antenna(std::span<const AntennaPattern> bands, const std::string& receiver_name,
                   TextFile* file) {
  const AntennaPattern& first = bands.front();
  file->labelled("", "START OF ANTENNA");
  const std::string name = first.is_receiver ? receiver_name : "LEONAV-SIM";
  const std::string serial = first.is_receiver ? "" : to_string(first.satellite);
  file->labelled(formatted("%-20s%-20s", name.c_str(), serial.c_str()), "TYPE / SERIAL NO");
  file->labelled("SIMULATED", "METH / BY / # / DATE");
  file->labelled("     0.0", "DAZI");
  const AntennaGrid& grid = first.variation;
  const bool empty = grid.azimuths == 0;
  const double last =
      empty ? 90.0 : (grid.first_angle + (grid.angles - 1) * grid.angle_step) / kDegree;
  file->labelled(formatted("  %6.1f%6.1f%6.1f", empty ? 0.0 : grid.first_angle / kDegree, last,
                           empty ? 90.0 : grid.angle_step / kDegree),
                 "ZEN1 / ZEN2 / DZEN");
  file->labelled(formatted("%6zu", bands.size()), "# OF FREQUENCIES");
  // RTKLIB ignores a satellite antenna without a beginning of validity.
  if (!first.is_receiver) {
    file->labelled("  1980     1     6     0     0    0.0000000", "VALID FROM");
  }
  for (const AntennaPattern& pattern : bands) write_band(pattern, file);
  file->labelled("", "END OF ANTENNA");
}

}  // namespace

void write_antex(const std::string& path, std::span<const AntennaPattern> patterns,
                 const std::string& receiver_name) {
  TextFile file(path);
  file.labelled("     1.4            M", "ANTEX VERSION / SYST");
  file.labelled("A", "PCV TYPE / REFANT");
  file.labelled("", "END OF HEADER");
  for (std::size_t begin = 0, end = 0; begin < patterns.size(); begin = end) {
    for (end = begin; end < patterns.size() && same_antenna(patterns[begin], patterns[end]);) ++end;
    write_antenna(patterns.subspan(begin, end - begin), receiver_name, &file);
  }
  file.close();
}

}  // namespace leonav::sim
