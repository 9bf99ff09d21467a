#include "core/filter/update/covariance_inflation.h"

namespace leonav {

using namespace ekf_index;

void inflate_covariance(Observable observable, double variance, double interval_s,
                        EkfCovariance* covariance) {
  const bool rates = observable == Observable::kDoppler;
  const double half_s = rates ? 0.5 * interval_s : 0.0;
  const auto add = [&](int first, int first_rate, int count) {
    for (int i = 0; i < count; ++i) {
      double& state = (*covariance)(first + i, first + i);
      double& rate = (*covariance)(first_rate + i, first_rate + i);
      if (!rates && state > 0.0) state += variance;
      if (!rates || !(rate > 0.0)) continue;
      rate += variance;
      if (!(state > 0.0)) continue;
      state += half_s * half_s * variance;
    }
  };
  add(kPosition, kVelocity, 3);
  add(kClock, kClockDrift, static_cast<int>(kMaxSystemTimes));
}

}  // namespace leonav
