// Road is a smooth curve through waypoints.
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "tools/sim/motion/smoothing_spline.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Position and shape of the road at one length.
struct RoadPlace {
  Eigen::Vector3d p_n;     // north, east, down from the route's origin, m
  double course = 0.0;     // rad clockwise from north, unwrapped along the road
  double slope = 0.0;      // rad, positive uphill
  double curvature = 0.0;  // 1/m in the horizontal, positive to the right
};

// The corners of the waypoints' polyline are rounded by two moving averages along its length. The
// curve is twice continuously differentiable and within a few metres of the corners.
class Road {
 public:
  // Throws std::runtime_error, with their names, for waypoints that are fewer than two, coincide,
  // climb above 45 degrees or turn back sharply.
  Road(const std::vector<Waypoint>& waypoints, double rounding_m);

  double length_m() const { return length_m_; }
  RoadPlace at(double s) const;  // s in [0, length_m()]
  // Returns the lengths along the road at which each waypoint is nearest.
  const std::vector<double>& waypoint_places() const { return places_; }

 private:
  std::array<SmoothingSpline, 3> position_;  // as functions of the length along the curve
  SmoothingSpline course_;
  double length_m_ = 0.0;
  std::vector<double> places_;
};

}  // namespace leonav::sim
