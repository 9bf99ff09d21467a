#include "core/inertial/alignment/external_heading.h"

#include "core/inertial/strapdown/imu_gap_fill.h"

namespace leonav {
namespace {

constexpr double kStandingSpeed_m_s = 0.2;

}  // namespace

bool may_be_stationary(double speed_3d, double sigma_v, double min_speed) {
  return speed_3d < kStandingSpeed_m_s + 2.0 * sigma_v && speed_3d < min_speed;
}

void ExternalHeading::set(const Heading& heading) {
  heading_ = heading;
  used_ = false;
  window_ = ImuSample();
}

std::optional<ExternalHeading::Heading> ExternalHeading::get() const { return heading_; }

void ExternalHeading::use() { used_ = true; }

void ExternalHeading::end_on_motion(const ImuSample& sample, double still_rate) {
  if (!heading_ || !used_) return;
  const bool gap =
      window_.time.is_set() && seconds_between(sample.start(), window_.time) > kMaxImuGap_s;
  if (gap) return heading_.reset();
  window_.time = sample.time;
  window_.interval_ns += sample.interval_ns;
  window_.delta_theta_b += sample.delta_theta_b;
  if (window_.interval_s() < kTurnWindow_s) return;
  if (!(window_.delta_theta_b.norm() < still_rate * window_.interval_s())) heading_.reset();
  window_ = ImuSample{.time = sample.time};
}

void ExternalHeading::end_on_motion(double speed_3d, double sigma_v, double min_speed) {
  if (!heading_ || !used_) return;
  if (!may_be_stationary(speed_3d, sigma_v, min_speed) || !(sigma_v < min_speed)) heading_.reset();
}

}  // namespace leonav
