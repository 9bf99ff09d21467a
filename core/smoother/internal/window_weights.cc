#include "core/smoother/internal/window_weights.h"

#include <algorithm>
#include <cmath>

#include "core/base/square.h"
#include "core/smoother/linearization.h"

namespace leonav {
namespace {

constexpr double kAlike_s = 1e-3;  // stamps are rounded

SatelliteId satellite_of(const Keyframe& keyframe, const KeyframeMeasurement& measurement) {
  return keyframe.satellites[measurement.measurement.satellite_index].satellite;
}

// Returns the index of the oldest keyframe at most so long before the newest.
int oldest_within(double horizon_s, const Window& window) {
  int oldest = window.size() - 1;
  while (oldest > 0 &&
         seconds_between(window.newest().time, window.at(oldest - 1).time) < horizon_s + kAlike_s)
    --oldest;
  return oldest;
}

}  // namespace

void WindowWeights::update_factors(bool first, const Eigen::Vector3d& lever_arm_b, Window* window) {
  const int oldest = oldest_within(horizon_s_, *window);
  for (int i = oldest; i < window->size(); ++i) {
    Keyframe& keyframe = window->at(i);
    const AntennaMotion antenna = antenna_of(keyframe, lever_arm_b);
    for (KeyframeMeasurement& measurement : keyframe.measurements)
      measurement.residual = linearize(measurement, keyframe, antenna).residual;
  }
  gather_means(*window, oldest);
  for (int i = oldest; i < window->size(); ++i) {
    Keyframe& keyframe = window->at(i);
    if (!first || keyframe.weights_decided) reweigh(&keyframe);
    keyframe.weights_decided = true;
  }
}

// The errors of the white part are independent after `correlation_time_s`. Over n such intervals
// their mean has 1/n of the variance.
void WindowWeights::gather_means(const Window& window, int oldest) {
  means_.clear();
  const int keyframes = window.size() - oldest;
  if (!(correlation_time_s_ > 0.0) || keyframes < 2) return;
  for (int i = oldest; i < window.size(); ++i) {
    const Keyframe& keyframe = window.at(i);
    for (const KeyframeMeasurement& measurement : keyframe.measurements) {
      if (measurement.measurement.observable != Observable::kCode) continue;
      CodeMean* mean = find_mean(satellite_of(keyframe, measurement), measurement.measurement.code);
      if (mean == nullptr) {
        if (means_.size() == means_.capacity()) continue;
        means_.push_back({satellite_of(keyframe, measurement), measurement.measurement.code});
        mean = &means_.back();
      }
      // A gross error is left to the test of the single residual.
      const double most = robust_.k1 * std::sqrt(measurement.variance);
      const double correlated_variance =
          std::min(measurement.variance, measurement.measurement.own_correlated_variance());
      ++mean->count;
      mean->residuals += std::clamp(measurement.residual, -most, most);
      mean->correlated_variance += correlated_variance;
      mean->white_variance += measurement.variance - correlated_variance;
    }
  }
  const double interval_s =
      seconds_between(window.newest().time, window.at(oldest).time) / (keyframes - 1);
  for (CodeMean& mean : means_) {
    const double errors = std::max(1.0, mean.count * interval_s / correlation_time_s_);
    const double n = std::min<double>(errors, mean.count);
    mean.ratio = mean.residuals / mean.count /
                 std::sqrt((mean.correlated_variance + mean.white_variance / n) / mean.count);
  }
}

WindowWeights::CodeMean* WindowWeights::find_mean(SatelliteId satellite, SignalCode code) {
  for (CodeMean& mean : means_)
    if (mean.satellite == satellite && mean.code == code) return &mean;
  return nullptr;
}

void WindowWeights::reweigh(Keyframe* keyframe) {
  for (KeyframeMeasurement& measurement : keyframe->measurements) {
    double factor =
        igg3_factor(measurement.residual / std::sqrt(measurement.variance), robust_.k0, robust_.k1);
    if (measurement.measurement.observable == Observable::kCode)
      if (const CodeMean* mean =
              find_mean(satellite_of(*keyframe, measurement), measurement.measurement.code))
        factor = std::min(factor, igg3_factor(mean->ratio, robust_.k0, robust_.k1));
    measurement.factor = factor;
  }
}

}  // namespace leonav
