#include "core/gnss/cycle_slips/internal/melbourne_wuebbena.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/gnss/signals/signal.h"

namespace leonav {
namespace {

constexpr double kMeanMemory = 60.0;                 // epochs
constexpr double kNoiseMemory = 100.0;               // epochs
constexpr double kModelWeight = 8.0;                 // epochs that the model's sigma counts as
constexpr double kMinRatio = 0.1, kMaxRatio = 16.0;  // of a variance to the model's
constexpr double kMaxSquare = 9.0;  // one epoch moves a variance by no more than a 3 sigma one

double blended(double variance, double epochs) {
  return std::clamp((kModelWeight + epochs * variance) / (kModelWeight + epochs), kMinRatio,
                    kMaxRatio);
}

}  // namespace

double melbourne_wuebbena_m(const PairValues& v, double first_hz, double second_hz) {
  const double difference = first_hz - second_hz, sum = first_hz + second_hz;
  return (first_hz * v.first_m - second_hz * v.second_m) / difference -
         (first_hz * v.first_code_m + second_hz * v.second_code_m) / sum;
}

double wide_lane_m(double first_hz, double second_hz) {
  return kSpeedOfLight / std::abs(first_hz - second_hz);
}

double melbourne_wuebbena_sigma_m(double code_sigma_m, double first_hz, double second_hz) {
  return code_sigma_m * std::hypot(first_hz, second_hz) / (first_hz + second_hz);
}

void MelbourneWuebbena::clear(bool keep_noise) {
  recent_.clear();
  mean_m_ = 0.0;
  epochs_ = 0.0;
  if (keep_noise) return;
  variance_ = step_variance_ = noise_epochs_ = 0.0;
}

double MelbourneWuebbena::mean_before() const {
  const double recent = std::accumulate(recent_.begin(), recent_.end(), 0.0);
  const double count = static_cast<double>(recent_.size());
  return (mean_m_ * epochs_ + recent) / (epochs_ + count);
}

MelbourneWuebbena::Deviation MelbourneWuebbena::deviation(double value_m,
                                                          double model_sigma_m) const {
  Deviation deviation;
  if (recent_.empty()) return deviation;
  const double count = epochs_ + static_cast<double>(recent_.size());
  const double unit = model_sigma_m * model_sigma_m;
  const double from_mean =
      std::sqrt(unit * blended(variance_, noise_epochs_) * (1.0 + 1.0 / count));
  const double from_last = std::sqrt(2.0 * unit * blended(step_variance_, noise_epochs_));
  const bool steps_are_steadier = from_last < from_mean;
  deviation.value_m = value_m - (steps_are_steadier ? recent_.back() : mean_before());
  deviation.sigma_m = std::min(from_last, from_mean);
  if (epochs_ >= 2.0 * kWindow && recent_.size() == kWindow) {
    const double recent = std::accumulate(recent_.begin() + 1, recent_.end(), value_m);
    deviation.window_m = recent / static_cast<double>(kWindow) - mean_m_;
    // Multipath lasts longer than the window: half of the variance does not average out.
    deviation.window_sigma_m =
        std::sqrt(unit * blended(variance_, noise_epochs_) *
                  (0.5 + 0.5 / static_cast<double>(kWindow) + 1.0 / epochs_));
  }
  return deviation;
}

void MelbourneWuebbena::learn(double value_m, double model_sigma_m) {
  const double unit = model_sigma_m * model_sigma_m;
  const double count = epochs_ + static_cast<double>(recent_.size());
  const double from_mean = value_m - mean_before();
  const double from_last = value_m - recent_.back();
  const double limit = kMaxSquare * blended(variance_, noise_epochs_);
  const double step_limit = kMaxSquare * blended(step_variance_, noise_epochs_);
  noise_epochs_ = std::min(noise_epochs_ + 1.0, kNoiseMemory);
  variance_ += (std::min(from_mean * from_mean / (unit * (1.0 + 1.0 / count)), limit) - variance_) /
               noise_epochs_;
  step_variance_ +=
      (std::min(from_last * from_last / (2.0 * unit), step_limit) - step_variance_) / noise_epochs_;
}

void MelbourneWuebbena::update(double value_m, double model_sigma_m) {
  if (!recent_.empty()) learn(value_m, model_sigma_m);
  if (recent_.size() == kWindow) {
    epochs_ = std::min(epochs_ + 1.0, kMeanMemory);
    mean_m_ += (recent_.front() - mean_m_) / epochs_;
    recent_.erase(recent_.begin());
  }
  recent_.push_back(value_m);
}

}  // namespace leonav
