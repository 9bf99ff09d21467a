#include "tools/sim/sky/clock_table.h"

#include <algorithm>
#include <cmath>

namespace leonav::sim {

ClockTable::ClockTable(double first_s, double last_s, double step_s, const ClockErrors& errors,
                       GaussianGenerator random)
    : first_s_(first_s), step_s_(step_s) {
  double offset = errors.offset_s + errors.drift * first_s, drift = errors.drift;
  const double root = std::sqrt(step_s);
  for (double t = first_s; t <= last_s + 2.0 * step_s; t += step_s) {
    nodes_.push_back({offset, drift});
    const double before = drift;
    drift += errors.drift_walk * root * random.draw();
    offset += 0.5 * (before + drift) * step_s + errors.phase_walk_s * root * random.draw();
  }
  // The drift between nodes follows the offsets, white frequency noise included.
  for (std::size_t i = 1; i + 1 < nodes_.size(); ++i) {
    nodes_[i].drift = (nodes_[i + 1].offset_s - nodes_[i - 1].offset_s) / (2.0 * step_s);
  }
}

ClockTable::Value ClockTable::at(double t) const {
  const double place = (t - first_s_) / step_s_;
  const double left = std::clamp(std::floor(place), 0.0, static_cast<double>(nodes_.size() - 2));
  const Value& a = nodes_[static_cast<std::size_t>(left)];
  const Value& b = nodes_[static_cast<std::size_t>(left) + 1];
  const double h = step_s_, x = place - left;
  const double rise = b.offset_s - a.offset_s;
  const double c2 = 3.0 * rise - h * (2.0 * a.drift + b.drift);
  const double c3 = h * (a.drift + b.drift) - 2.0 * rise;
  return {a.offset_s + x * (h * a.drift + x * (c2 + x * c3)),
          a.drift + x * (2.0 * c2 + 3.0 * c3 * x) / h};
}

}  // namespace leonav::sim
