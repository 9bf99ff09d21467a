#include "tools/sim/places/odometer.h"

#include <algorithm>
#include <cmath>

namespace leonav::sim {
namespace {

constexpr double kStep_s = 0.2;

}  // namespace

Odometer::Odometer(const SplineMotion& motion) : travelled_{0.0} {
  double before = motion.at(0.0).v_e.norm();
  for (double t = kStep_s; t <= motion.duration_s();
       t = kStep_s * static_cast<double>(travelled_.size())) {
    const double now = motion.at(t).v_e.norm();
    travelled_.push_back(travelled_.back() + 0.5 * (before + now) * kStep_s);
    before = now;
  }
  travelled_.push_back(travelled_.back());
}

double Odometer::travelled_m(double t) const {
  const double last = static_cast<double>(travelled_.size() - 1);
  const double place = std::clamp(t / kStep_s, 0.0, last);
  const auto left = static_cast<std::size_t>(std::min(std::floor(place), last - 1.0));
  const double share = place - static_cast<double>(left);
  return travelled_[left] + share * (travelled_[left + 1] - travelled_[left]);
}

double Odometer::speed_m_s(double t) const {
  return (travelled_m(t + kStep_s) - travelled_m(t - kStep_s)) / (2.0 * kStep_s);
}

double Odometer::when_s(double travelled_m) const {
  const auto first = std::lower_bound(travelled_.begin(), travelled_.end(), travelled_m);
  return kStep_s * static_cast<double>(first - travelled_.begin());
}

}  // namespace leonav::sim
