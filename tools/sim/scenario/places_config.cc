#include "tools/sim/scenario/places_config.h"
#include "core/base/angle.h"

namespace leonav::sim {
namespace {

void read_segment(ConfigReader& group, PlacesConfig* places) {
  PlaceSegment segment;
  PlaceKind kind = PlaceKind::kOpenSky;
  group.number("from_s", {0.0, 1e6}, &segment.from_s);
  group.number("from_m", {0.0, 1e7}, &segment.from_m);
  group.choice<PlaceKind>("place",
                          {{"open_sky", PlaceKind::kOpenSky},
                           {"suburban", PlaceKind::kSuburban},
                           {"urban_canyon", PlaceKind::kUrbanCanyon},
                           {"viaduct", PlaceKind::kViaduct},
                           {"woods", PlaceKind::kWoods},
                           {"tunnel", PlaceKind::kTunnel}},
                          &kind);
  Place place = usual_place(kind);
  constexpr Bounds kLength = {0.0, 1e4}, kDb = {0.0, 60.0}, kFactor = {0.0, 1e3};
  group.number("horizon_deg", {0.0, 90.0}, &place.horizon, kDegree);
  group.number("street_width_m", kLength, &place.street_width);
  group.number("house_height_m", kLength, &place.house_height);
  group.number("house_height_sigma_m", kLength, &place.house_height_sigma);
  group.number("house_length_m", {1.0, 1e4}, &place.house_length);
  group.number("gap_share", {0.0, 1.0}, &place.gap_share);
  group.number("crossing_every_m", {10.0, 1e5}, &place.crossing_every);
  group.number("crossing_width_m", kLength, &place.crossing_width);
  group.number("reflection_db", kDb, &place.reflection_db);
  group.number("deck_width_m", kLength, &place.deck_width);
  group.number("deck_height_m", kLength, &place.deck_height);
  group.number("leaves_db", kDb, &place.leaves_db);
  group.number("leaves_sigma_db", kDb, &place.leaves_sigma_db);
  group.number("multipath", kFactor, &place.multipath);
  group.number("slips", kFactor, &place.slips);
  if (segment.from_s.has_value() == segment.from_m.has_value())
    group.report("place", "needs either from_s or from_m, not both");
  segment.place = place;
  segment.where = group.where(segment.from_s ? "from_s" : "from_m");
  places->segments.push_back(segment);
}

}  // namespace

Place usual_place(PlaceKind kind) {
  Place place;
  place.kind = kind;
  switch (kind) {
    case PlaceKind::kOpenSky:
      break;
    case PlaceKind::kSuburban:
      place.horizon = 8.0 * kDegree;
      place.street_width = 26.0;
      place.house_height = 8.0;
      place.house_height_sigma = 2.5;
      place.house_length = 15.0;
      place.gap_share = 0.35;
      place.crossing_width = 16.0;
      place.multipath = 2.0;
      place.slips = 2.0;
      break;
    case PlaceKind::kUrbanCanyon:
      place.horizon = 12.0 * kDegree;
      place.street_width = 28.0;
      place.house_height = 24.0;
      place.house_height_sigma = 10.0;
      place.house_length = 30.0;
      place.gap_share = 0.12;
      place.crossing_width = 24.0;
      place.multipath = 4.0;
      place.slips = 6.0;
      break;
    case PlaceKind::kViaduct:
      place.horizon = 10.0 * kDegree;
      place.deck_width = 18.0;
      place.deck_height = 7.0;
      place.multipath = 4.0;
      place.slips = 6.0;
      break;
    case PlaceKind::kWoods:
      place.horizon = 10.0 * kDegree;
      place.leaves_db = 5.0;
      place.leaves_sigma_db = 4.0;
      place.multipath = 2.5;
      place.slips = 5.0;
      break;
    case PlaceKind::kTunnel:
      break;
  }
  return place;
}

void read_places(ConfigReader& root, PlacesConfig* places) {
  if (root.is_scalar("places")) {
    root.choice<PlaceMix>("places",
                          {{"none", PlaceMix::kNone},
                           {"city", PlaceMix::kCity},
                           {"dense_city", PlaceMix::kDenseCity}},
                          &places->mix);
    return;
  }
  root.groups("places", [&](ConfigReader& r) { read_segment(r, places); });
}

}  // namespace leonav::sim
