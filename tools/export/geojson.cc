#include "tools/common/format.h"
#include "tools/export/map_formats.h"
#include "tools/export/point_attributes.h"
#include "tools/export/utc_text.h"
#include "tools/export/xml_text.h"

namespace leonav {
namespace {

std::string coordinates_of(const SolutionRow& row) {
  const Geodetic& position = row.pva.position;
  return "[" + decimal(position.longitude * kDegreesPerRadian, 9) + "," +
         decimal(position.latitude * kDegreesPerRadian, 9) + "," + decimal(position.height, 3) +
         "]";
}

std::string line_of(const std::string& name, std::span<const SolutionRow> rows) {
  std::string text =
      "{\"type\":\"Feature\",\"geometry\":{\"type\":\"LineString\",\"coordinates\":[";
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0) text += ",";
    text += coordinates_of(rows[i]);
  }
  return text + "]},\"properties\":{\"name\":" + json_string(valid_text(name)) + ",\"begin\":\"" +
         utc_text(rows.front().pva.time) + "\",\"end\":\"" + utc_text(rows.back().pva.time) +
         "\",\"points\":" + std::to_string(rows.size()) + "}}";
}

std::string point_of(const SolutionRow& row) {
  std::string text = "{\"type\":\"Feature\",\"geometry\":{\"type\":\"Point\",\"coordinates\":" +
                     coordinates_of(row) + "},\"properties\":{\"time\":\"" +
                     utc_text(row.pva.time) + "\",\"source\":\"" + std::string(source_name(row)) +
                     "\"";
  for (const PointAttribute& one : attributes_of(row)) {
    text += ",\"" + std::string(one.name) +
            "\":" + (one.value ? decimal(*one.value, one.decimals) : "null");
  }
  return text + "}}";
}

}  // namespace

void write_geojson(const MapTrack& track, OutputFile* file) {
  file->write("{\"type\":\"FeatureCollection\",\"features\":[\n");
  std::string separator;
  for (const TrackPart& part : track.parts) {
    const std::size_t points = part.last - part.first;
    if (points < 2) continue;  // one point is no line
    file->write(separator + line_of(track.name, track.rows.subspan(part.first, points)));
    separator = ",\n";
  }
  for (const SolutionRow& row : track.rows) {
    file->write(separator + point_of(row));
    separator = ",\n";
  }
  file->write("\n]}\n");
}

}  // namespace leonav
