// leonav-export writes solutions as files that other programs read: GPX, KML, GeoJSON, MCAP.
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>

#include "tools/common/arguments.h"
#include "tools/export/export_track.h"
#include "tools/export/map_formats.h"
#include "tools/export/mcap_track.h"

namespace {

using namespace leonav;

Arguments declare() {
  Arguments arguments(
      "leonav-export", "RUN --out FILE [options]",
      "Writes solutions as a file that other programs read. RUN is a journal, a log with "
      "SOLUTION,\n"
      "or a solution.csv of leonav-replay or leonav-smooth. The ending of FILE chooses the "
      "format:\n"
      "\n"
      "  .gpx       GPX 1.1: hiking and mapping programs, JOSM\n"
      "  .kml       KML 2.2: Google Earth, QGIS\n"
      "  .geojson   GeoJSON (also .json): QGIS, web maps, geopandas\n"
      "  .mcap      MCAP with messages of ROS 2: Foxglove, ros2 bag, PlotJuggler\n"
      "\n"
      "Points carry sigmas, source, satellites and protection levels; times are UTC; no line "
      "joins\n"
      "what lies on either side of a gap. docs/operations/export.md explains each format.\n"
      "Exit codes: 0 done; 1 a file cannot be used, or RUN has no position; 2 command line.");
  arguments.option("--out", "FILE", "the file to write; it is replaced once the new one is whole")
      .option("--format", "NAME", "gpx, kml, geojson or mcap, whatever the ending")
      .option("--rate", "HZ",
              "at most so many points per second of the run, 0.001 to 1000; all: every one.\n"
              "                        1 unless given, of MCAP all")
      .option("--gap", "SECONDS",
              "no line over a longer time without position; five median\n"
              "                        intervals, at least 2 s, unless given")
      .option("--geoid-separation", "M",
              "height of the geoid above the ellipsoid: GPX and KML then have heights\n"
              "                        above sea level. Unless given, GPX has heights above the\n"
              "                        ellipsoid and KML lies on the ground")
      .option("--prefix", "TEXT", "of a log's channels, as lcm.prefix", "LEONAV_")
      .flag("--smoothed", "of a journal: SMOOTHED, the smoother's states at a fixed lag")
      .option("--name", "TEXT", "name of the track; the name of RUN unless given");
  return arguments;
}

constexpr std::array<std::string_view, 4> kFormats = {"gpx", "kml", "geojson", "mcap"};

std::string format_of(const Arguments& arguments, const std::string& out) {
  std::string name = arguments.get("--format");
  if (name.empty()) {
    name = std::filesystem::path(out).extension().string();
    if (!name.empty()) name.erase(0, 1);
    if (name == "json") name = "geojson";
  }
  for (const std::string_view known : kFormats) {
    if (name == known) return name;
  }
  throw UsageError("the format " + (name.empty() ? "of " + out : "'" + name + "'") +
                   " is not known; end FILE with .gpx, .kml, .geojson or .mcap, or give --format");
}

std::optional<double> number_within(const Arguments& arguments, const std::string& name,
                                    double least, double most) {
  if (!arguments.has(name)) return std::nullopt;
  const double value = arguments.number(name);
  if (value >= least && value <= most) return value;
  throw UsageError(name + ": must be " + std::to_string(least) + " to " + std::to_string(most));
}

std::optional<double> rate_of(const Arguments& arguments, const std::string& format) {
  if (!arguments.has("--rate")) return format == "mcap" ? std::nullopt : std::optional(1.0);
  if (arguments.get("--rate") == "all") return std::nullopt;
  return number_within(arguments, "--rate", 0.001, 1000.0);
}

void refuse_same_file(const std::string& run, const std::string& out) {
  std::error_code error;
  if (std::filesystem::equivalent(run, out, error)) {
    throw UsageError("--out: " + out + " is the file that is read; give another name");
  }
}

std::string summary_of(const MapTrack& map) {
  const auto predictions = static_cast<std::size_t>(std::count_if(
      map.rows.begin(), map.rows.end(), [](const auto& row) { return is_prediction(row); }));
  const std::size_t parts = map.parts.size() - predictions;
  std::string text = std::to_string(map.rows.size()) + " points in " + std::to_string(parts) +
                     (parts == 1 ? " part" : " parts");
  if (predictions > 0) {
    text += ", and " + std::to_string(predictions) +
            " of them are predictions without GNSS and IMU, which no line joins";
  }
  return text;
}

int body(int argc, char** argv) {
  Arguments arguments = declare();
  if (!arguments.parse(argc, argv)) return 0;
  if (arguments.positional().size() != 1) throw UsageError("expected one RUN");
  const std::string run = arguments.positional().front(), out = arguments.required("--out");
  const std::string format = format_of(arguments, out);
  refuse_same_file(run, out);
  TrackChoice choice;
  choice.prefix = arguments.get("--prefix");
  choice.smoothed = arguments.has("--smoothed");
  choice.rate_hz = rate_of(arguments, format);
  const auto gap_s = number_within(arguments, "--gap", 0.0, 1e9);
  const auto geoid_m = number_within(arguments, "--geoid-separation", -200.0, 200.0);

  const ExportTrack track = load_track(run, choice);
  for (const std::string& warning : track.warnings) {
    std::cerr << "leonav-export: WARNING " << warning << "\n";
  }
  OutputFile file(out);
  if (format == "mcap") {
    const McapCounts counts = write_mcap(track.rows, &file);
    file.commit();
    std::cout << out << ": " << counts.fixes << " fixes, " << counts.odometries << " odometries\n";
    return 0;
  }
  const MapTrack map{arguments.has("--name") ? arguments.get("--name")
                                             : std::filesystem::path(run).filename().string(),
                     track.rows, parts_of(track.rows, gap_s ? *gap_s : default_gap_s(track.rows)),
                     geoid_m};
  if (format == "gpx") write_gpx(map, &file);
  if (format == "kml") write_kml(map, &file);
  if (format == "geojson") write_geojson(map, &file);
  file.commit();
  std::cout << out << ": " << summary_of(map) << "\n";
  return 0;
}

}  // namespace

int main(int argc, char** argv) { return run_tool("leonav-export", body, argc, argv); }
