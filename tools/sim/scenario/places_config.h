// What stands around the vehicle, by segment of its way.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config_reader.h"

namespace leonav::sim {

enum class PlaceKind { kOpenSky, kSuburban, kUrbanCanyon, kViaduct, kWoods, kTunnel };

// Lengths in m, as seen from the vehicle; what a kind does not have is 0.
struct Place {
  PlaceKind kind = PlaceKind::kOpenSky;
  double horizon = 0.05;  // rad: nothing is received below
  // Houses on both sides of the street, which runs where the vehicle heads.
  double street_width = 0.0;
  double house_height = 0.0, house_height_sigma = 0.0, house_length = 25.0;
  double gap_share = 0.0;  // of the houses that are not there
  double crossing_every = 250.0, crossing_width = 0.0;
  double reflection_db =
      9.0;  // lost by a reflection at their walls, 1 sigma 3 dB from house to house
  // A deck over the street.
  double deck_width = 0.0, deck_height = 0.0;
  // Leaves over it all.
  double leaves_db = 0.0, leaves_sigma_db = 0.0;  // at the zenith; slanting rays have more
  double multipath = 1.0;                         // factor on that of an open place
  double slips = 1.0;                             // likewise
};

// With what is usual of its kind.
Place usual_place(PlaceKind kind);

struct PlaceSegment {
  std::optional<double> from_s, from_m;  // one of them; m along the way
  Place place;
  std::string where;  // in the scenario, for errors; empty: drawn
};

// A way through a town, drawn at random.
enum class PlaceMix { kNone, kCity, kDenseCity };

struct PlacesConfig {
  PlaceMix mix = PlaceMix::kNone;
  std::vector<PlaceSegment> segments;  // in order; before the first: open sky
};

// The key "places": the name of a mix or a list of segments.
void read_places(ConfigReader& root, PlacesConfig* places);

}  // namespace leonav::sim
