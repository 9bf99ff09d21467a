#include <cmath>

#include "tools/export/map_formats.h"
#include "tools/export/point_attributes.h"
#include "tools/export/utc_text.h"
#include "tools/export/xml_text.h"

namespace leonav {
namespace {

std::string extensions_of(const SolutionRow& row) {
  std::string text =
      "<extensions><leonav:source>" + std::string(source_name(row)) + "</leonav:source>";
  for (const PointAttribute& one : attributes_of(row)) {
    if (!one.value) continue;
    const std::string name(one.name);
    text += "<leonav:" + name + ">" + decimal(*one.value, one.decimals) + "</leonav:" + name + ">";
  }
  return text + "</extensions>";
}

// The order of the elements is the schema's.
std::string point_of(const SolutionRow& row, double geoid_separation_m) {
  const Geodetic& position = row.pva.position;
  std::string text = "<trkpt lat=\"" + decimal(position.latitude * kDegreesPerRadian, 9) +
                     "\" lon=\"" + decimal(position.longitude * kDegreesPerRadian, 9) + "\"><ele>" +
                     decimal(position.height - geoid_separation_m, 3) + "</ele><time>" +
                     utc_text(row.pva.time) + "</time>";
  // GPX knows no dead reckoning: without recent GNSS there is no fix.
  if (row.source == Source::kEkf || row.source == Source::kSmoother ||
      row.source == Source::kAligning) {
    text += "<fix>3d</fix>";
  }
  if (row.satellites && *row.satellites >= 0)
    text += "<sat>" + std::to_string(*row.satellites) + "</sat>";
  if (row.pdop && *row.pdop >= 0.0) text += "<pdop>" + decimal(*row.pdop, 2) + "</pdop>";
  return text + extensions_of(row) + "</trkpt>\n";
}

}  // namespace

void write_gpx(const MapTrack& track, OutputFile* file) {
  file->write(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<gpx version=\"1.1\" creator=\"leonav-export\" "
      "xmlns=\"http://www.topografix.com/GPX/1/1\" xmlns:leonav=\"urn:leonav:solution\" "
      "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:schemaLocation=\"http://www.topografix.com/GPX/1/1 "
      "http://www.topografix.com/GPX/1/1/gpx.xsd\">\n"
      "<trk><name>" +
      xml_text(track.name) + "</name>\n");
  for (const TrackPart& part : track.parts) {
    file->write("<trkseg>\n");
    for (std::size_t i = part.first; i < part.last; ++i) {
      file->write(point_of(track.rows[i], track.geoid_separation_m.value_or(0.0)));
    }
    file->write("</trkseg>\n");
  }
  file->write("</trk>\n</gpx>\n");
}

}  // namespace leonav
