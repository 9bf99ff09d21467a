#include "core/vehicle/carrier_speed.h"

#include "core/earth/ellipsoid.h"

namespace leonav {

void CarrierSpeed::add(const std::optional<AntennaChange>& change) {
  if (!change || change->from != now_.time) {
    samples_.clear();
    now_ = Sample();
    if (!change) return;
    samples_.push_back({change->from, now_.displacement_e});
  }
  now_ = {change->to, now_.displacement_e + change->change_e};
  // Keeps the newest sample that is at least kWindow_s old, and all samples after it.
  while (samples_.size() > 1 && seconds_between(now_.time, samples_[1].time) >= kWindow_s)
    samples_.erase(samples_.begin());
  if (seconds_between(now_.time, samples_.back().time) >= kSampleInterval_s &&
      samples_.size() < samples_.capacity())
    samples_.push_back(now_);
}

std::optional<double> CarrierSpeed::horizontal(const Eigen::Vector3d& antenna_p_e) const {
  if (samples_.empty()) return std::nullopt;
  const double since_s = seconds_between(now_.time, samples_.front().time);
  if (since_s < kWindow_s) return std::nullopt;
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(antenna_p_e));
  return (C_ne * (now_.displacement_e - samples_.front().displacement_e)).head<2>().norm() /
         since_s;
}

}  // namespace leonav
