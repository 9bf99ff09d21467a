#include "tools/sim/places/surroundings.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/earth/rotation.h"
#include "tools/sim/places/city_mix.h"
#include "tools/sim/scenario/lattice_noise.h"
#include "tools/sim/scenario/random_streams.h"

namespace leonav::sim {
namespace {

constexpr double kAntennaHeight = 1.6;  // m above the street
constexpr double kLaneOffset = 2.5;     // vehicle's distance right of the middle
constexpr double kWavelength = 0.19;    // m
// A ray almost along the street meets houses only at its far end, which the horizon represents.
constexpr double kFarthestHouse = 400.0;  // m
constexpr double kRoofEdge_db = 0.05;     // losses below this are none

double to_wall(const Place& place, int side) {
  return std::max(1.0, 0.5 * place.street_width - side * kLaneOffset);
}

}  // namespace

double knife_edge_loss_db(double clearance_m, double distance_m, double wavelength_m) {
  const double v = -clearance_m * std::sqrt(2.0 / (wavelength_m * distance_m));
  if (v <= -0.78) return 0.0;
  return 6.9 + 20.0 * std::log10(std::hypot(v - 0.1, 1.0) + v - 0.1);
}

Surroundings::Surroundings(const Scenario& scenario, const SplineMotion& motion)
    : motion_(motion), odometer_(motion), seed_(scenario.seed) {
  segments_.push_back({-1e9, usual_place(PlaceKind::kOpenSky)});
  std::vector<PlaceSegment> segments = scenario.places.segments;
  if (scenario.places.mix != PlaceMix::kNone) {
    segments = city_places(scenario.places.mix, odometer_.travelled_m(motion.duration_s()),
                           random_stream(scenario.seed, "places"));
  }
  for (const PlaceSegment& segment : segments) {
    const double from_s = segment.from_s ? *segment.from_s : odometer_.when_s(*segment.from_m);
    if (from_s < segments_.back().from_s) {
      throw std::runtime_error(segment.where +
                               ": begins before the segment ahead of it; put them in order");
    }
    segments_.push_back({from_s, segment.place});
  }
}

double Surroundings::course_at(double t) const {
  const MotionInstant now = motion_.at(t);
  const Eigen::Matrix3d C_en = rotation_ecef_to_ned(to_geodetic(now.p_e));
  const Eigen::Vector3d forward_n = C_en * (now.q_eb * Eigen::Vector3d::UnitX());
  return std::atan2(forward_n.y(), forward_n.x());
}

PlaceNow Surroundings::at(double t) const {
  PlaceNow now;
  while (now.segment + 1 < segments_.size() && segments_[now.segment + 1].from_s <= t)
    ++now.segment;
  now.place = &segments_[now.segment].place;
  constexpr double kStep_s = 0.05;
  now.course = course_at(t);
  now.course_rate = wrap_to_pi(course_at(t + kStep_s) - course_at(t - kStep_s)) / (2.0 * kStep_s);
  now.travelled_m = odometer_.travelled_m(t);
  now.speed_m_s = odometer_.speed_m_s(t);
  return now;
}

// Returns the height of the house on one side (+1 right, -1 left) of the street at `along_m` of its
// length; 0 if there is none. `house` gets a number of its own, never 0.
double Surroundings::house_height(const PlaceNow& now, int side, double along_m,
                                  unsigned* house) const {
  const Place& place = *now.place;
  const double crossing =
      along_m - place.crossing_every * std::floor(along_m / place.crossing_every);
  if (crossing < place.crossing_width) return 0.0;
  const auto index = static_cast<std::int64_t>(std::floor(along_m / place.house_length));
  const std::uint64_t number = (static_cast<std::uint64_t>(index) << 20) |
                               (static_cast<std::uint64_t>(now.segment) << 1) |
                               (side > 0 ? 1U : 0U);
  GaussianGenerator random = random_stream(seed_, "house", number);
  *house = static_cast<unsigned>(stream_key(seed_, "wall", number) >> 33) | 1U;
  if (random.uniform() <= place.gap_share) return 0.0;
  const double height = place.house_height + place.house_height_sigma * random.draw();
  return std::clamp(height, 0.3 * place.house_height, 3.0 * place.house_height);
}

bool Surroundings::reflect(const PlaceNow& now, const LookAngles& direction,
                           const LookAngles& rates, Reception* reflected) const {
  const Place& place = *now.place;
  const double bearing = direction.azimuth - now.course;
  const double across = std::abs(std::sin(bearing));
  const int hidden_side = std::sin(bearing) > 0.0 ? 1 : -1;
  // horizontal distance to the mirror
  const double distance = to_wall(place, -hidden_side) / across;
  if (distance > kFarthestHouse) return false;
  const double forward = std::cos(bearing), rise = std::tan(direction.elevation);
  unsigned wall = 0, none = 0;
  // The ray meets a wall, and on its way there passes over the houses that hide the direct signal.
  if (house_height(now, -hidden_side, now.travelled_m + distance * forward, &wall) <
      kAntennaHeight + distance * rise) {
    return false;
  }
  // The mirror turns the ray across the street, not along it.
  const double whole = (place.street_width + to_wall(place, -hidden_side)) / across;
  if (house_height(now, hidden_side, now.travelled_m + whole * forward, &none) >
      kAntennaHeight + whole * rise) {
    return false;
  }
  reflected->line_of_sight = false;
  reflected->route = wall;
  reflected->loss_db =
      std::max(3.0, place.reflection_db + 3.0 * random_stream(seed_, "facade", wall).draw());
  reflected->mirror_m = 2.0 * to_wall(place, -hidden_side);
  const double c = std::cos(direction.elevation), s = std::sin(direction.elevation);
  reflected->extra_m = reflected->mirror_m * across * c;
  reflected->extra_m_s = reflected->mirror_m *
                         (hidden_side * std::cos(bearing) * (rates.azimuth - now.course_rate) * c -
                          across * s * rates.elevation);
  return true;
}

void Surroundings::pass_houses(const PlaceNow& now, const LookAngles& direction,
                               const LookAngles& rates, Reception* reception) const {
  const double bearing = direction.azimuth - now.course;
  const int side = std::sin(bearing) > 0.0 ? 1 : -1;
  const double across = std::max(1e-6, std::abs(std::sin(bearing)));
  const double distance = to_wall(*now.place, side) / across;
  if (distance > kFarthestHouse) return;
  unsigned house = 0;
  const double height =
      house_height(now, side, now.travelled_m + distance * std::cos(bearing), &house);
  if (height == 0.0) return;
  const double over = kAntennaHeight + distance * std::tan(direction.elevation) - height;
  const double slant = distance / std::cos(direction.elevation);
  const double edge = knife_edge_loss_db(over * std::cos(direction.elevation), slant, kWavelength);
  if (edge < kRoofEdge_db) return;
  reception->loss_db += edge;
  Reception reflected;
  if (over >= 0.0 || !reflect(now, direction, rates, &reflected)) return;
  if (reflected.loss_db < reception->loss_db) *reception = reflected;
}

Reception Surroundings::reception(const PlaceNow& now, SatelliteId satellite,
                                  const LookAngles& direction, const LookAngles& rates) const {
  const Place& place = *now.place;
  Reception reception;
  reception.possible = place.kind != PlaceKind::kTunnel && direction.elevation >= place.horizon;
  if (!reception.possible) return reception;
  if (place.house_height > 0.0) pass_houses(now, direction, rates, &reception);
  if (place.deck_width > 0.0) {
    // Distance from the street's middle at which the ray passes the deck's height.
    const double across = (place.deck_height - kAntennaHeight) / std::tan(direction.elevation) *
                          std::sin(direction.azimuth - now.course);
    const double beside = std::abs(across + kLaneOffset) - 0.5 * place.deck_width;
    const double slant = (place.deck_height - kAntennaHeight) / std::sin(direction.elevation);
    reception.loss_db +=
        knife_edge_loss_db(beside * std::sin(direction.elevation), slant, kWavelength);
  }
  if (place.leaves_db > 0.0) {
    // Trunks and crowns pass by every few metres; in the wind the loss also changes at rest.
    constexpr double kCrown = 4.0;  // m
    const LatticeNoise fade(stream_key(seed_, "leaves", table_index_of(satellite)));
    const double leaves =
        place.leaves_db + place.leaves_sigma_db * fade.at(now.travelled_m / kCrown).value;
    reception.loss_db += std::max(0.0, leaves) / std::max(0.25, std::sin(direction.elevation));
  }
  return reception;
}

}  // namespace leonav::sim
