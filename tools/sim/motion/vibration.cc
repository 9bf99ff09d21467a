#include "tools/sim/motion/vibration.h"

#include <cmath>
#include <numbers>

namespace leonav {

// The filter is the bilinear transform of s / (s^2 + s w0 / Q + w0^2), with w0 the band's geometric
// mean.
Vibration::Vibration(const VibrationModel& model, double rate_hz, GaussianGenerator random)
    : model_(model), random_(random) {
  const double centre_hz = std::sqrt(model.low_hz * model.high_hz);
  const double w = 2.0 * std::numbers::pi * centre_hz / rate_hz;
  const double alpha = 0.5 * std::sin(w) * (model.high_hz - model.low_hz) / centre_hz;
  gain_ = alpha / (1.0 + alpha);
  feedback_1_ = 2.0 * std::cos(w) / (1.0 + alpha);
  feedback_2_ = -(1.0 - alpha) / (1.0 + alpha);
  gain_ /= std::sqrt(impulse_energy());  // unit noise gives unit root mean square
}

double Vibration::impulse_energy() const {
  double energy = 0.0, out_1 = 0.0, out_2 = 0.0;
  for (int i = 0; i < 100'000; ++i) {
    const double in = i == 0 ? gain_ : i == 2 ? -gain_ : 0.0;
    const double out = in + feedback_1_ * out_1 + feedback_2_ * out_2;
    energy += out * out;
    out_2 = out_1;
    out_1 = out;
  }
  return energy;
}

Vibration::Shaking Vibration::next(double speed_m_s) {
  Six in;
  in << random_.draw_three(), random_.draw_three();
  const Six out = gain_ * (in - in_2_) + feedback_1_ * out_1_ + feedback_2_ * out_2_;
  in_2_ = in_1_;
  in_1_ = in;
  out_2_ = out_1_;
  out_1_ = out;
  return {(model_.accel_idle + model_.accel_per_speed * speed_m_s) * out.head<3>(),
          (model_.gyro_idle + model_.gyro_per_speed * speed_m_s) * out.tail<3>()};
}

}  // namespace leonav
