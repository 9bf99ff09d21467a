#include "tools/sim/route/speed_profile.h"

#include <algorithm>
#include <cmath>

namespace leonav::sim {
namespace {

constexpr double kGrid = 0.5;       // m
constexpr double kSmoothing = 1.0;  // s, of each of two moving averages
constexpr double kCrawl = 0.05;     // m/s

// Limits at the grid's points: waypoints, bends, then what can be reached from and braked to.
std::vector<double> limits(const Road& road, const RouteConfig& route,
                           const std::vector<Waypoint>& waypoints) {
  const auto count = static_cast<std::size_t>(road.length_m() / kGrid) + 1;
  std::vector<double> v(count);
  std::size_t leg = 0;
  const std::vector<double>& places = road.waypoint_places();
  for (std::size_t i = 0; i < count; ++i) {
    const double s = kGrid * static_cast<double>(i);
    while (leg + 1 < places.size() && places[leg + 1] <= s) ++leg;
    const double bend = std::abs(road.at(s).curvature);
    v[i] = std::min(waypoints[leg].speed_m_s,
                    std::sqrt(route.max_lateral_m_s2 / std::max(bend, 1e-6)));
  }
  for (std::size_t w = 0; w < places.size(); ++w) {
    const auto i = static_cast<std::size_t>(std::lround(places[w] / kGrid));
    if (waypoints[w].stop_s > 0.0) v[std::min(i, count - 1)] = 0.0;
  }
  v.front() = v.back() = 0.0;
  for (std::size_t i = 1; i < count; ++i) {
    v[i] =
        std::min(v[i], std::sqrt(v[i - 1] * v[i - 1] + 2.0 * route.max_acceleration_m_s2 * kGrid));
  }
  for (std::size_t i = count - 1; i-- > 0;) {
    v[i] = std::min(v[i], std::sqrt(v[i + 1] * v[i + 1] + 2.0 * route.max_braking_m_s2 * kGrid));
  }
  return v;
}

// Means over `width` samples, centred; constant beyond both ends.
std::vector<double> averaged(const std::vector<double>& values, int width) {
  const int half = width / 2, n = static_cast<int>(values.size());
  const auto at = [&](int i) { return values[static_cast<std::size_t>(std::clamp(i, 0, n - 1))]; };
  std::vector<double> result;
  result.reserve(values.size());
  for (int i = 0; i < n; ++i) {
    double sum = 0.0;
    for (int j = -half; j <= half; ++j) sum += at(i + j) - at(i);
    result.push_back(at(i) + sum / (2 * half + 1));
  }
  return result;
}

// Seconds at which the grid's points are reached, and left where it stands there.
struct Passage {
  double arrival, departure;
};

std::vector<Passage> passages(const std::vector<double>& v, const Road& road,
                              const RouteConfig& route, const std::vector<Waypoint>& waypoints) {
  std::vector<Passage> passage(v.size());
  passage[0] = {0.0, route.standing_s};
  for (std::size_t i = 1; i < v.size(); ++i) {
    const double t = passage[i - 1].departure + 2.0 * kGrid / std::max(v[i - 1] + v[i], kCrawl);
    passage[i] = {t, t};
    for (std::size_t w = 1; v[i] == 0.0 && w < waypoints.size(); ++w) {
      const auto place = static_cast<std::size_t>(std::lround(road.waypoint_places()[w] / kGrid));
      if (place == i) passage[i].departure = t + waypoints[w].stop_s;
    }
  }
  return passage;
}

}  // namespace

std::vector<double> drive_along(const Road& road, const RouteConfig& route,
                                const std::vector<Waypoint>& waypoints, double duration_s) {
  const std::vector<double> v = limits(road, route, waypoints);
  const std::vector<Passage> passage = passages(v, road, route, waypoints);
  std::vector<double> s;
  std::size_t i = 0;
  // Beyond the end too, so that the averages are of a motion.
  for (double t = 0.0; t <= duration_s + 4.0 * kSmoothing;
       t = kDriveStep * static_cast<double>(s.size())) {
    while (i + 1 < passage.size() && passage[i + 1].arrival <= t) ++i;
    double place = kGrid * static_cast<double>(i);
    if (i + 1 < passage.size() && t > passage[i].departure) {
      // Uniformly accelerated between two points of the grid.
      const double dt = t - passage[i].departure;
      const double whole = passage[i + 1].arrival - passage[i].departure;
      const double a = (v[i + 1] - v[i]) / whole;
      place += std::min(kGrid, v[i] * dt + 0.5 * a * dt * dt);
    }
    s.push_back(place);
  }
  const int width = static_cast<int>(std::lround(kSmoothing / kDriveStep));
  s = averaged(averaged(s, width), width);
  s.resize(static_cast<std::size_t>(std::floor(duration_s / kDriveStep + 1e-9)) + 1);
  return s;
}

}  // namespace leonav::sim
