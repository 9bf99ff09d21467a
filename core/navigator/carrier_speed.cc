#include "core/navigator/carrier_speed.h"

#include "core/earth/ellipsoid.h"
#include "core/earth/rotation.h"

namespace leonav {

void CarrierSpeed::add(const std::optional<AntennaChange>& change) {
  if (!change || change->from != now_.time) {
    kept_.clear();
    now_ = Kept();
    if (!change) return;
    kept_.push_back({change->from, now_.way_e});
  }
  now_ = {change->to, now_.way_e + change->change_e};
  // The newest that is old enough, and all after it.
  while (kept_.size() > 1 && seconds_between(now_.time, kept_[1].time) >= kWindow_s)
    kept_.erase(kept_.begin());
  if (seconds_between(now_.time, kept_.back().time) >= kKeptEvery_s &&
      kept_.size() < kept_.capacity())
    kept_.push_back(now_);
}

std::optional<double> CarrierSpeed::horizontal(const Eigen::Vector3d& antenna_p_e) const {
  if (kept_.empty()) return std::nullopt;
  const double since_s = seconds_between(now_.time, kept_.front().time);
  if (since_s < kWindow_s) return std::nullopt;
  const Eigen::Matrix3d C_ne = rotation_ecef_to_ned(to_geodetic(antenna_p_e));
  return (C_ne * (now_.way_e - kept_.front().way_e)).head<2>().norm() / since_s;
}

}  // namespace leonav
