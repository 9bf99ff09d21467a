#include "tools/sim/sky/orbit_table.h"

#include <algorithm>
#include <cmath>

namespace leonav::sim {

OrbitTable::OrbitTable(double first_s, double step_s, const std::vector<OrbitState>& states)
    : first_s_(first_s), step_s_(step_s) {
  for (const OrbitState& s : states) nodes_.push_back({s.p_i, s.v_i, gravitation_i(s.p_i)});
}

OrbitState OrbitTable::at(double t) const {
  const double place = (t - first_s_) / step_s_;
  const double left = std::clamp(std::floor(place), 0.0, static_cast<double>(nodes_.size() - 2));
  const Node& a = nodes_[static_cast<std::size_t>(left)];
  const Node& b = nodes_[static_cast<std::size_t>(left) + 1];
  const double h = step_s_, x = place - left;
  // p(x) = p + h v x + h^2 a/2 x^2 + c3 x^3 + c4 x^4 + c5 x^5, matched at x = 1.
  const Eigen::Vector3d v = h * a.v, w = 0.5 * h * h * a.a;
  const Eigen::Vector3d rest = b.p - a.p - v - w;
  const Eigen::Vector3d slope = h * b.v - v - 2.0 * w;
  const Eigen::Vector3d bend = 0.5 * h * h * b.a - w;
  const Eigen::Vector3d c3 = 10.0 * rest - 4.0 * slope + bend;
  const Eigen::Vector3d c4 = -15.0 * rest + 7.0 * slope - 2.0 * bend;
  const Eigen::Vector3d c5 = 6.0 * rest - 3.0 * slope + bend;
  OrbitState now;
  now.p_i = a.p + x * (v + x * (w + x * (c3 + x * (c4 + x * c5))));
  now.v_i = (v + x * (2.0 * w + x * (3.0 * c3 + x * (4.0 * c4 + x * 5.0 * c5)))) / h;
  return now;
}

}  // namespace leonav::sim
