// PlacesConfig describes the surroundings of the vehicle, by segment of its way.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "daemon/config/config_reader.h"

namespace leonav::sim {

enum class PlaceKind { kOpenSky, kSuburban, kUrbanCanyon, kViaduct, kWoods, kTunnel };

// Surroundings of one segment, lengths in m as seen from the vehicle; 0 where a kind has none.
struct Place {
  PlaceKind kind = PlaceKind::kOpenSky;
  double horizon = 0.05;  // rad: nothing is received below
  // Houses on both sides of the street, which runs along the vehicle's course.
  double street_width = 0.0;
  double house_height = 0.0, house_height_sigma = 0.0, house_length = 25.0;
  double gap_share = 0.0;  // share of the houses that are missing
  double crossing_every = 250.0, crossing_width = 0.0;
  // Loss of a reflection at the walls; it varies by 3 dB (1 sigma) from house to house.
  double reflection_db = 9.0;
  // A deck over the street.
  double deck_width = 0.0, deck_height = 0.0;
  // Leaves above everything.
  double leaves_db = 0.0, leaves_sigma_db = 0.0;  // at the zenith; slanting rays have more
  double multipath = 1.0;                         // factor of that in an open place
  double slips = 1.0;                             // factor of that in an open place
};

// Returns the usual values of a kind.
Place usual_place(PlaceKind kind);

// A segment of the way with its place.
struct PlaceSegment {
  std::optional<double> from_s, from_m;  // one of them is set; m along the way
  Place place;
  std::string where;  // line in the scenario, for errors; empty: drawn
};

// Random mixes of places for a way through a town.
enum class PlaceMix { kNone, kCity, kDenseCity };

struct PlacesConfig {
  PlaceMix mix = PlaceMix::kNone;
  std::vector<PlaceSegment> segments;  // in order; before the first: open sky
};

// Reads the key "places": the name of a mix or a list of segments.
void read_places(ConfigReader& root, PlacesConfig* places);

}  // namespace leonav::sim
