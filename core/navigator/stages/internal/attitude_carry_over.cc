#include "core/navigator/stages/internal/attitude_carry_over.h"

#include <algorithm>

#include "core/filter/state/covariance_blocks.h"
#include "core/navigator/interface/filter_estimate.h"

namespace leonav {
namespace {

constexpr double kMinHeadingSigma = 0.1;  // rad

}  // namespace

AttitudeCarryOver::AttitudeCarryOver(const Ekf& filter, double levelling_sigma)
    : q_eb_(filter.state().q_eb),
      sigma_rpy_(sigma_of_euler(filter)),
      errors_(filter.state().errors),
      error_covariance_(imu_error_covariance(filter.covariance())),
      random_walk_(filter.filter_state().random_walk) {
  sigma_rpy_.head<2>() = sigma_rpy_.head<2>().cwiseMax(levelling_sigma);
  sigma_rpy_.z() = std::max(2.0 * sigma_rpy_.z(), kMinHeadingSigma);
}

void AttitudeCarryOver::give_to(Ekf* filter, GpsTime time) const {
  filter->set_attitude(q_eb_, sigma_rpy_, errors_, error_covariance_);
  if (random_walk_.noise > 0.0)  // the convergence of the attitude continues
    filter->raise_attitude_noise(random_walk_.noise, seconds_between(random_walk_.until, time));
}

}  // namespace leonav
