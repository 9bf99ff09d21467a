#include "tools/sim/route/road.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/earth/rotation.h"

namespace leonav::sim {
namespace {

constexpr double kStep = 0.5;  // m between the samples of the curve

using Points = std::vector<Eigen::Vector3d>;

// Equidistant samples of the polyline, prolonged at both ends so that rounding keeps them.
Points sampled(const std::vector<Waypoint>& waypoints, const std::vector<double>& places,
               double margin_m) {
  Points points;
  const double end = places.back() + margin_m;
  std::size_t leg = 0;
  for (double s = -margin_m; s <= end; s += kStep) {
    while (leg + 2 < places.size() && s > places[leg + 1]) ++leg;
    const double share = (s - places[leg]) / (places[leg + 1] - places[leg]);
    points.push_back(waypoints[leg].p_n + share * (waypoints[leg + 1].p_n - waypoints[leg].p_n));
  }
  return points;
}

// Mean over 2 * half + 1 points; half fewer points at either end.
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

}  // namespace

Road::Road(const std::vector<Waypoint>& waypoints, double rounding_m) {
  if (waypoints.size() < 2) throw std::runtime_error("a route needs two waypoints or more");
  places_.push_back(0.0);
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    const double leg = (waypoints[i].p_n - waypoints[i - 1].p_n).norm();
    if (!(leg > 1.0)) {
      throw std::runtime_error("waypoints " + std::to_string(i) + " and " + std::to_string(i + 1) +
                               " are less than a metre apart");
    }
    places_.push_back(places_.back() + leg);
  }
  const auto half = static_cast<std::size_t>(std::ceil(0.5 * rounding_m / kStep));
  const double margin_m = 2.0 * static_cast<double>(half) * kStep;
  const Points curve = averaged(averaged(sampled(waypoints, places_, margin_m), half), half);
  length_m_ = places_.back();
  std::vector<double> s, course;
  for (std::size_t i = 0; i < curve.size(); ++i) s.push_back(kStep * static_cast<double>(i));
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    for (const Eigen::Vector3d& p : curve) values.push_back(p[axis]);
    position_[static_cast<std::size_t>(axis)] = SmoothingSpline(s, values, 0.0);
  }
  length_m_ = std::min(length_m_, s.back());
  for (const double at : s) {
    const double now = std::atan2(position_[1].evaluate(at).first, position_[0].evaluate(at).first);
    course.push_back(course.empty() ? now : course.back() + wrap_to_pi(now - course.back()));
  }
  course_ = SmoothingSpline(s, course, 0.0);
  for (double& place : places_) place = std::min(place, length_m_);
}

RoadPlace Road::at(double s) const {
  const auto n = position_[0].evaluate(s), e = position_[1].evaluate(s),
             d = position_[2].evaluate(s);
  const double speed = std::hypot(n.first, e.first);  // per metre of polyline
  RoadPlace place;
  place.p_n = {n.value, e.value, d.value};
  place.course = course_.evaluate(s).value;
  place.slope = std::atan2(-d.first, speed);
  place.curvature = (n.first * e.second - e.first * n.second) / (speed * speed * speed);
  return place;
}

}  // namespace leonav::sim
