// This unit writes a track as GPX, KML and GeoJSON.
//
// Points carry their attributes under the names of solution.csv's columns; lines join the points of
// a part only (parts_of). Times are UTC.
#pragma once
#include <span>
#include <string>

#include "tools/export/export_track.h"
#include "tools/export/output_file.h"

namespace leonav {

// What the writers need; `name` is that of the track.
struct MapTrack {
  std::string name;
  std::span<const SolutionRow> rows;
  std::vector<TrackPart> parts;
  // Height of the geoid above the ellipsoid, m: subtracted from the heights of GPX and KML, which
  // are above sea level by their standards.
  std::optional<double> geoid_separation_m;
};

// GPX 1.1 (Topografix): one track, a segment for each part, attributes as extensions. Without a
// geoid separation the elevations are those above the ellipsoid.
void write_gpx(const MapTrack& track, OutputFile* file);

// KML 2.2 (OGC 07-147r2): a folder with a line for each part, and one with the points. Without a
// geoid separation both are drawn on the ground.
void write_kml(const MapTrack& track, OutputFile* file);

// GeoJSON (RFC 7946): a line for each part, then the points. Heights are above the ellipsoid, as
// the standard has them.
void write_geojson(const MapTrack& track, OutputFile* file);

}  // namespace leonav
