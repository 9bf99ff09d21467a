#include "core/gnss/measurement/weighting.h"

#include <algorithm>
#include <cmath>

namespace leonav {

double elevation_factor(double elevation) {
  return elevation >= kFullWeightElevation ? 1.0 : 0.5 * sine_factor(elevation);
}

double sine_factor(double elevation) {
  constexpr double kSinOneDegree = 0.01745240643728351;
  return 1.0 / std::max(std::sin(elevation), kSinOneDegree);
}

double noise_factor(const GnssConfig& config, double elevation, double cn0_dbhz) {
  if (config.weight_model == WeightModel::kSine) return sine_factor(elevation);
  const double by_elevation = elevation_factor(elevation);
  if (config.weight_model != WeightModel::kCn0 || !std::isfinite(cn0_dbhz)) return by_elevation;
  return std::max(by_elevation, std::pow(10.0, (config.cn0_reference_dbhz - cn0_dbhz) / 20.0));
}

IonosphereFree ionosphere_free(double frequency1_hz, double frequency2_hz) {
  const double f1 = frequency1_hz * frequency1_hz;
  const double f2 = frequency2_hz * frequency2_hz;
  return {f1 / (f1 - f2), -f2 / (f1 - f2)};
}

double combined_sigma(const IonosphereFree& combination, double sigma1, double sigma2) {
  return std::hypot(combination.gamma1 * sigma1, combination.gamma2 * sigma2);
}

}  // namespace leonav
