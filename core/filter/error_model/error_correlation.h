// ErrorCorrelation learns how long errors of one satellite's signal stay alike.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>
#include <memory>

#include "core/base/gps_time.h"
#include "core/filter/error_model/error_class.h"
#include "core/filter/update/robust_update.h"

namespace leonav {

// White noise plus a first-order Gauss-Markov process: the autocorrelation of the sum at lag t > 0
// is share * exp(-t / time_s).
struct CorrelationModel {
  double share = 0.0;   // of the variance that is correlated, 0 to 1
  double time_s = 1.0;  // of the process
};

// Returns by how much the variance of a long mean exceeds that of the mean of white errors of the
// same size, when one error is seen every `dt` seconds:
//   1 + 2 sum_n rho(n dt) = (1 + (2 share - 1) r) / (1 - r),   r = exp(-dt / time_s)
// (Brockwell and Davis, Introduction to Time Series and Forecasting, 2016, 2.4.1).
double variance_inflation(const CorrelationModel& model, double dt);

// The autocorrelation comes from products of standardized errors of one satellite and signal,
// collected by lag over a fading memory:
//   c(lag) = mean(u(t) u(t - lag)),   u = residual or innovation over its sigma
// The model is the one of a fixed set of correlation times that fits c(lag) / c(0) best, with the
// share between 0 and 1; errors smaller than their sigmas, c(0) < 1, have the share c(0) times
// that. Classes are observable, elevation and whether the vehicle stands; those with few samples
// lean on their observable, and that on the configured model.
class ErrorCorrelation {
 public:
  struct Sample {
    SatelliteId satellite;
    SignalCode code;
    ErrorClass of;
    double ratio = 0.0;  // u
  };

  // By observable and motion.
  using Priors = std::array<std::array<CorrelationModel, kMotionClasses>, kObservables>;
  explicit ErrorCorrelation(const Priors& priors);
  void reset();
  // Adds to the epoch at `time`.
  void add(const Sample& sample, GpsTime time);
  // Ends the epoch, `interval_s` after the one before, and fits the models.
  void end_epoch(double interval_s);
  const CorrelationModel& model(const ErrorClass& of) const {
    return models_[of.observable][of.motion][of.elevation];
  }

 private:
  static constexpr std::size_t kLags = 9;      // bins: 0; about 1, 2, 4, ... 128 s
  static constexpr std::size_t kHistory = 48;  // samples kept of a signal
  struct Lag {
    double count = 0.0, product = 0.0, lag_s = 0.0;  // sums
    Lag& operator+=(const Lag& other) {
      count += other.count, product += other.product, lag_s += other.lag_s;
      return *this;
    }
    Lag& operator*=(double factor) {
      count *= factor, product *= factor, lag_s *= factor;
      return *this;
    }
  };
  using Lags = std::array<Lag, kLags>;
  struct Past {
    GpsTime time;
    double ratio = 0.0;
    std::size_t motion = 0;
  };
  struct History {
    SatelliteId satellite;
    SignalCode code;
    std::size_t observable = 0;
    GpsTime last;
    std::size_t next = 0, count = 0;  // of the ring
    std::array<Past, kHistory> past;
  };
  struct Histories {
    boost::container::static_vector<History, kMaxMeasurements> entries;
  };

  History* history_of(const Sample& sample, GpsTime time);

  template <typename T>
  using ByClass =
      std::array<std::array<std::array<T, kElevationClasses>, kMotionClasses>, kObservables>;

  Priors priors_;
  ByClass<Lags> lags_;
  ByClass<CorrelationModel> models_;
  std::unique_ptr<Histories> histories_;
};

}  // namespace leonav
