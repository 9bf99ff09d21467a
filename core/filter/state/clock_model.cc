#include "core/filter/state/clock_model.h"

#include "core/base/square.h"

namespace leonav {
namespace {

using namespace ekf_index;

void start(Eigen::Index index, double sigma, EkfCovariance* covariance) {
  covariance->row(index).setZero();
  covariance->col(index).setZero();
  (*covariance)(index, index) = square(sigma);
}

}  // namespace

void propagate_clocks(const ClockModel& model, const ClockFlags& known, double dt,
                      EkfCovariance* covariance) {
  EkfCovariance& P = *covariance;
  P.middleRows<4>(kClock) += dt * P.middleRows<4>(kClockDrift);
  P.middleCols<4>(kClock) += dt * P.middleCols<4>(kClockDrift);
  for (Eigen::Index i = 0; i < 4; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const double own = i == j ? 1.0 : 0.0;
      const double drift = square(model.drift_noise) + own * square(model.inter_system_drift_noise);
      const double offset = square(model.offset_noise) + own * square(model.inter_system_noise);
      if (known.drift[a] && known.drift[b]) P(kClockDrift + i, kClockDrift + j) += drift * dt;
      if (known.offset[a] && known.drift[b]) {
        P(kClock + i, kClockDrift + j) += drift * dt * dt / 2.0;
        P(kClockDrift + j, kClock + i) += drift * dt * dt / 2.0;
      }
      if (known.offset[a] && known.offset[b])
        P(kClock + i, kClock + j) += offset * dt + drift * dt * dt * dt / 3.0;
    }
  }
}

void start_clock_offset(std::size_t system, double offset_m, double sigma_m, ClockState* clocks,
                        EkfCovariance* covariance) {
  const auto i = static_cast<Eigen::Index>(system);
  clocks->offset_m(i) = offset_m;
  start(kClock + i, sigma_m, covariance);
}

void start_clock_drift(std::size_t system, double drift_m_s, double sigma_m_s, ClockState* clocks,
                       EkfCovariance* covariance) {
  const auto i = static_cast<Eigen::Index>(system);
  clocks->drift_m_s(i) = drift_m_s;
  start(kClockDrift + i, sigma_m_s, covariance);
}

void copy_clock_drift(std::size_t from, std::size_t to, double sigma_m_s, ClockState* clocks,
                      EkfCovariance* covariance) {
  const auto f = static_cast<Eigen::Index>(from), t = static_cast<Eigen::Index>(to);
  clocks->drift_m_s(t) = clocks->drift_m_s(f);
  EkfCovariance& P = *covariance;
  P.row(kClockDrift + t) = P.row(kClockDrift + f);
  P.col(kClockDrift + t) = P.col(kClockDrift + f);
  P(kClockDrift + t, kClockDrift + t) = P(kClockDrift + f, kClockDrift + f) + square(sigma_m_s);
}

}  // namespace leonav
