#include "tools/sim/route/speed_profile.h"

#include <algorithm>
#include <cmath>

namespace leonav::sim {
namespace {

constexpr double kGrid = 0.5;       // m, at most
constexpr double kSmoothing = 1.0;  // length of each of two moving averages
constexpr double kReach = 1.0;      // range of both averages, before and after
constexpr double kCrawl = 0.05;     // m/s

// Points along the road; every waypoint is one, so that stops are exactly at their waypoints.
struct Grid {
  std::vector<double> place;          // m along the road
  std::vector<std::size_t> waypoint;  // index for each waypoint
};

Grid make_grid(const Road& road) {
  Grid grid;
  const std::vector<double>& places = road.waypoint_places();
  for (std::size_t w = 0; w + 1 < places.size(); ++w) {
    grid.waypoint.push_back(grid.place.size());
    const double leg = places[w + 1] - places[w];
    const auto parts = static_cast<std::size_t>(std::ceil(leg / kGrid));
    for (std::size_t i = 0; i < parts; ++i)
      grid.place.push_back(places[w] + leg * static_cast<double>(i) / static_cast<double>(parts));
  }
  grid.waypoint.push_back(grid.place.size());
  grid.place.push_back(places.back());
  return grid;
}

// Extends each limit by the reach of the averages, so that the averaged speed keeps it too.
std::vector<double> held_longer(const Grid& grid, const std::vector<double>& limit) {
  std::vector<double> held = limit;
  for (std::size_t i = 0; i < limit.size(); ++i) {
    const double reach_m = limit[i] * kReach;
    for (std::size_t j = i; j-- > 0 && grid.place[i] - grid.place[j] < reach_m;)
      held[j] = std::min(held[j], limit[i]);
    for (std::size_t j = i + 1; j < limit.size() && grid.place[j] - grid.place[i] < reach_m; ++j)
      held[j] = std::min(held[j], limit[i]);
  }
  return held;
}

// Returns the limits at the grid's points: waypoints, bends, then accelerations and braking.
std::vector<double> limits(const Grid& grid, const Road& road, const RouteConfig& route,
                           const std::vector<Waypoint>& waypoints) {
  const std::size_t count = grid.place.size();
  std::vector<double> v(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double bend = std::abs(road.at(grid.place[i]).curvature);
    v[i] = std::sqrt(route.max_lateral_m_s2 / std::max(bend, 1e-6));
  }
  for (std::size_t w = 0; w + 1 < waypoints.size(); ++w) {
    for (std::size_t i = grid.waypoint[w]; i <= grid.waypoint[w + 1]; ++i)
      v[i] = std::min(v[i], waypoints[w].speed_m_s);
  }
  v = held_longer(grid, v);
  for (std::size_t w = 0; w < waypoints.size(); ++w)
    if (waypoints[w].stop_s > 0.0) v[grid.waypoint[w]] = 0.0;
  v.front() = v.back() = 0.0;
  const auto reachable = [&](std::size_t from, std::size_t to, double acceleration) {
    const double way = std::abs(grid.place[to] - grid.place[from]);
    v[to] = std::min(v[to], std::sqrt(v[from] * v[from] + 2.0 * acceleration * way));
  };
  for (std::size_t i = 1; i < count; ++i) reachable(i - 1, i, route.max_acceleration_m_s2);
  for (std::size_t i = count - 1; i-- > 0;) reachable(i + 1, i, route.max_braking_m_s2);
  return v;
}

// Returns centred means over `width` samples; the values are constant beyond both ends.
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

// Times, in s, at which a grid point is reached, and left after a stop.
struct Passage {
  double arrival, departure;
};

// The averages shorten a stop by kReach at either end.
std::vector<Passage> passages(const Grid& grid, const std::vector<double>& v,
                              const RouteConfig& route, const std::vector<Waypoint>& waypoints) {
  std::vector<Passage> passage(v.size());
  passage[0] = {0.0, std::max(route.standing_s, waypoints[0].stop_s) + kReach};
  std::size_t w = 1;
  for (std::size_t i = 1; i < v.size(); ++i) {
    const double way = grid.place[i] - grid.place[i - 1];
    const double t = passage[i - 1].departure + 2.0 * way / std::max(v[i - 1] + v[i], kCrawl);
    passage[i] = {t, t};
    if (i != grid.waypoint[w]) continue;
    if (waypoints[w].stop_s > 0.0) passage[i].departure += waypoints[w].stop_s + 2.0 * kReach;
    ++w;
  }
  return passage;
}

}  // namespace

std::vector<double> drive_along(const Road& road, const RouteConfig& route,
                                const std::vector<Waypoint>& waypoints, double duration_s) {
  const Grid grid = make_grid(road);
  const std::vector<double> v = limits(grid, road, route, waypoints);
  const std::vector<Passage> passage = passages(grid, v, route, waypoints);
  std::vector<double> s;
  std::size_t i = 0;
  // The samples continue beyond the end, so that the averages have values there.
  for (double t = 0.0; t <= duration_s + 4.0 * kSmoothing;
       t = kDriveStep * static_cast<double>(s.size())) {
    while (i + 1 < passage.size() && passage[i + 1].arrival <= t) ++i;
    double place = grid.place[i];
    if (i + 1 < passage.size() && t > passage[i].departure) {
      // The acceleration is uniform between two points of the grid.
      const double dt = t - passage[i].departure;
      const double whole = passage[i + 1].arrival - passage[i].departure;
      const double a = (v[i + 1] - v[i]) / whole;
      place = std::min(grid.place[i + 1], place + v[i] * dt + 0.5 * a * dt * dt);
    }
    s.push_back(place);
  }
  const int width = static_cast<int>(std::lround(kSmoothing / kDriveStep));
  s = averaged(averaged(s, width), width);
  s.resize(static_cast<std::size_t>(std::floor(duration_s / kDriveStep + 1e-9)) + 1);
  return s;
}

}  // namespace leonav::sim
