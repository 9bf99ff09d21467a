#include "tools/export/map_formats.h"
#include "tools/export/point_attributes.h"
#include "tools/export/utc_text.h"
#include "tools/export/xml_text.h"

namespace leonav {
namespace {

constexpr std::string_view kHead =
    "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
    "<kml xmlns=\"http://www.opengis.net/kml/2.2\">\n<Document>\n";
constexpr std::string_view kStyles =
    "<Style id=\"line\"><LineStyle><color>ff0055ff</color><width>3</width></LineStyle></Style>\n"
    "<Style id=\"point\"><IconStyle><scale>0.3</scale></IconStyle>"
    "<LabelStyle><scale>0</scale></LabelStyle></Style>\n";

std::string coordinates_of(const SolutionRow& row, double geoid_separation_m) {
  const Geodetic& position = row.pva.position;
  return decimal(position.longitude * kDegreesPerRadian, 9) + "," +
         decimal(position.latitude * kDegreesPerRadian, 9) + "," +
         decimal(position.height - geoid_separation_m, 3);
}

std::string schema_of(const SolutionRow& row) {
  std::string text =
      "<Schema name=\"solution\" id=\"solution\">"
      "<SimpleField type=\"string\" name=\"source\"></SimpleField>";
  for (const PointAttribute& one : attributes_of(row)) {
    text += "<SimpleField type=\"double\" name=\"" + std::string(one.name) + "\"></SimpleField>";
  }
  return text + "</Schema>\n";
}

std::string data_of(const SolutionRow& row) {
  std::string text =
      "<ExtendedData><SchemaData schemaUrl=\"#solution\"><SimpleData name=\"source\">" +
      std::string(source_name(row)) + "</SimpleData>";
  for (const PointAttribute& one : attributes_of(row)) {
    if (!one.value) continue;
    text += "<SimpleData name=\"" + std::string(one.name) + "\">" +
            decimal(*one.value, one.decimals) + "</SimpleData>";
  }
  return text + "</SchemaData></ExtendedData>";
}

// Writes the geometries of one file, all with the same altitudes.
class KmlGeometry {
 public:
  explicit KmlGeometry(const std::optional<double>& geoid_separation_m)
      : separation_m_(geoid_separation_m.value_or(0.0)),
        mode_(geoid_separation_m ? "<altitudeMode>absolute</altitudeMode>"
                                 : "<altitudeMode>clampToGround</altitudeMode>") {}

  void write_line(std::span<const SolutionRow> rows, OutputFile* file) const {
    const std::string begin = utc_text(rows.front().pva.time), end = utc_text(rows.back().pva.time);
    file->write("<Placemark><name>" + begin + "</name><TimeSpan><begin>" + begin + "</begin><end>" +
                end +
                "</end></TimeSpan><styleUrl>#line</styleUrl><LineString><tessellate>1"
                "</tessellate>" +
                mode_ + "<coordinates>\n");
    for (const SolutionRow& row : rows) file->write(coordinates_of(row, separation_m_) + "\n");
    file->write("</coordinates></LineString></Placemark>\n");
  }

  void write_point(const SolutionRow& row, OutputFile* file) const {
    const std::string time = utc_text(row.pva.time);
    file->write("<Placemark><name>" + time + "</name><TimeStamp><when>" + time +
                "</when></TimeStamp><styleUrl>#point</styleUrl>" + data_of(row) + "<Point>" +
                mode_ + "<coordinates>" + coordinates_of(row, separation_m_) +
                "</coordinates></Point></Placemark>\n");
  }

 private:
  double separation_m_;
  std::string mode_;
};

}  // namespace

void write_kml(const MapTrack& track, OutputFile* file) {
  file->write(kHead);
  file->write("<name>" + xml_text(track.name) + "</name>\n");
  file->write(kStyles);
  file->write(schema_of(track.rows.front()));
  const KmlGeometry geometry(track.geoid_separation_m);
  file->write("<Folder><name>track</name>\n");
  for (const TrackPart& part : track.parts) {
    if (part.last - part.first < 2) continue;  // one point is no line
    geometry.write_line(track.rows.subspan(part.first, part.last - part.first), file);
  }
  file->write("</Folder>\n<Folder><name>points</name>\n");
  for (const SolutionRow& row : track.rows) geometry.write_point(row, file);
  file->write("</Folder>\n</Document>\n</kml>\n");
}

}  // namespace leonav
