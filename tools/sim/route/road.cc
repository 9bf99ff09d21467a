#include "tools/sim/route/road.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "core/earth/rotation.h"

namespace leonav::sim {
namespace {

constexpr double kStep = 0.5;                         // m between the samples of the curve
const double kSharpest = -0.5 * std::numbers::sqrt3;  // cosine of the sharpest turn

using Points = std::vector<Eigen::Vector3d>;

// Returns equidistant samples of the polyline, extended at both ends so that rounding preserves
// them.
Points sampled(const std::vector<Waypoint>& waypoints, const std::vector<double>& places,
               double margin_m) {
  Points points;
  const double end = places.back() + margin_m + kStep;
  std::size_t leg = 0;
  for (double s = -margin_m; s <= end; s += kStep) {
    while (leg + 2 < places.size() && s > places[leg + 1]) ++leg;
    const double share = (s - places[leg]) / (places[leg + 1] - places[leg]);
    points.push_back(waypoints[leg].p_n + share * (waypoints[leg + 1].p_n - waypoints[leg].p_n));
  }
  return points;
}

// Returns means over 2 * half + 1 points, half fewer points at either end.
Points averaged(const Points& points, std::size_t half) {
  Points result;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += points[i];
    if (i >= 2 * half) {
      result.push_back(sum / static_cast<double>(2 * half + 1));
      sum -= points[i - 2 * half];
    }
  }
  return result;
}

// Returns the length along the rounded curve for a position along the polyline sampled every kStep.
double length_at(const std::vector<double>& s, double along_polyline) {
  const auto i = std::min(static_cast<std::size_t>(along_polyline / kStep), s.size() - 2);
  const double share = along_polyline / kStep - static_cast<double>(i);
  return s[i] + share * (s[i + 1] - s[i]);
}

}  // namespace

Road::Road(const std::vector<Waypoint>& waypoints, double rounding_m) {
  if (waypoints.size() < 2) throw std::runtime_error("a route needs two waypoints or more");
  places_.push_back(0.0);
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const Eigen::Vector3d way = waypoints[i].p_n - waypoints[i - 1].p_n;
    const double leg = way.norm();
    const auto refuse = [&waypoints](std::size_t which, const char* why) {
      throw std::runtime_error(waypoints[which].where + ": " + why);
    };
    if (!(leg > 1.0)) {
      refuse(i, "is less than a metre from the waypoint before; leave one out");
    }
    if (!(std::abs(way.z()) <= way.head<2>().norm())) {
      refuse(i, "is steeper than 45 degrees from the waypoint before: no course; put it farther");
    }
    if (i > 1) {
      const Eigen::Vector3d before = waypoints[i - 1].p_n - waypoints[i - 2].p_n;
      const double cosine = before.head<2>().normalized().dot(way.head<2>().normalized());
      if (cosine < kSharpest) {
        refuse(i - 1,
               "the road turns back on itself here by more than 150 degrees; go round with one "
               "waypoint more");
      }
    }
    places_.push_back(places_.back() + leg);
  }
  const auto half = static_cast<std::size_t>(std::ceil(0.5 * rounding_m / kStep));
  const double margin_m = 2.0 * static_cast<double>(half) * kStep;
  const Points curve = averaged(averaged(sampled(waypoints, places_, margin_m), half), half);
  std::vector<double> s{0.0}, course;
  for (std::size_t i = 1; i < curve.size(); ++i)
    s.push_back(s.back() + (curve[i] - curve[i - 1]).norm());
  for (double& place : places_) place = length_at(s, place);
  length_m_ = places_.back();
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : curve) values.push_back(p[axis]);
    position_[static_cast<std::size_t>(axis)] = SmoothingSpline(s, values, 0.0);
  }
  for (const double at : s) {
    const double now = std::atan2(position_[1].evaluate(at).first, position_[0].evaluate(at).first);
    course.push_back(course.empty() ? now : course.back() + wrap_to_pi(now - course.back()));
  }
  course_ = SmoothingSpline(s, course, 0.0);
}

RoadPlace Road::at(double s) const {
  const auto n = position_[0].evaluate(s), e = position_[1].evaluate(s),
             d = position_[2].evaluate(s);
  const double speed = std::hypot(n.first, e.first);  // per metre of road
  RoadPlace place;
  place.p_n = {n.value, e.value, d.value};
  place.course = course_.evaluate(s).value;
  place.slope = std::atan2(-d.first, speed);
  place.curvature = (n.first * e.second - e.first * n.second) / (speed * speed * speed);
  return place;
}

}  // namespace leonav::sim
