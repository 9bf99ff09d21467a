#include "core/navigator/monitors/outage_monitor.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

constexpr double kOutage_s = 5.0;  // shorter ones are common in every street
constexpr double kAsBefore = 1.5;
constexpr double kUsual = 1.5;  // times the shorter of the last two intervals

double sigma_of(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(0.0, covariance.trace()));
}

}  // namespace

std::optional<OutageMonitor::Over> OutageMonitor::add(GpsTime time, const Position& before,
                                                      const Position& after) {
  std::optional<Over> over;
  const double gap_s = last_.is_set() ? seconds_between(time, last_) : 0.0;
  const double usual_s = std::min(last_intervals_s_[0], last_intervals_s_[1]);
  const bool known = last_intervals_s_[0] > 0.0;
  if (last_.is_set()) last_intervals_s_ = {last_intervals_s_[1], gap_s};
  if (known && gap_s >= kOutage_s && gap_s > kUsual * usual_s) {
    const double step_m = (after.p_e - before.p_e).norm();
    over = Over{gap_s, step_m, step_m / std::max(1e-6, sigma_of(before.covariance))};
    if (!converging_) sigma_then_m_ = sigma_m_;
    ended_ = time;
    converging_ = true;
  }
  last_ = time;
  sigma_m_ = sigma_of(after.covariance);
  return over;
}

std::optional<double> OutageMonitor::reconverged() {
  if (!converging_ || sigma_m_ > kAsBefore * sigma_then_m_) return std::nullopt;
  converging_ = false;
  return seconds_between(last_, ended_);
}

}  // namespace leonav
