#include "tools/sim/places/city_mix.h"

#include <cmath>

namespace leonav::sim {
namespace {

struct Share {
  PlaceKind kind;
  double city, dense_city;  // shares of the segments
  double length_m;          // mean
};
constexpr Share kShares[] = {
    {PlaceKind::kOpenSky, 0.12, 0.02, 300.0},     {PlaceKind::kSuburban, 0.24, 0.06, 400.0},
    {PlaceKind::kUrbanCanyon, 0.42, 0.74, 350.0}, {PlaceKind::kViaduct, 0.12, 0.12, 120.0},
    {PlaceKind::kWoods, 0.08, 0.03, 200.0},       {PlaceKind::kTunnel, 0.02, 0.03, 80.0},
};
constexpr double kDenseHeight = 1.7;    // factor of the city's house heights
constexpr double kOpenStart_m = 100.0;  // a navigator must find its heading first

}  // namespace

std::vector<PlaceSegment> city_places(PlaceMix mix, double length_m, GaussianGenerator random) {
  std::vector<PlaceSegment> segments;
  double from_m = kOpenStart_m;
  while (mix != PlaceMix::kNone && from_m < length_m) {
    double rest = random.uniform();
    const double stretch = 0.5 + random.uniform();
    const double taller = random.draw();
    for (const Share& share : kShares) {
      rest -= mix == PlaceMix::kCity ? share.city : share.dense_city;
      if (rest > 1e-9) continue;
      PlaceSegment segment;
      segment.from_m = from_m;
      segment.place = usual_place(share.kind);
      // Every street has its own height.
      segment.place.house_height *= std::exp(0.25 * taller);
      if (mix == PlaceMix::kDenseCity) segment.place.house_height *= kDenseHeight;
      segments.push_back(segment);
      from_m += share.length_m * stretch;
      break;
    }
  }
  return segments;
}

}  // namespace leonav::sim
