// WindowWeights decides the robust weights of the window's newest measurements together.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include "core/robust/igg3.h"
#include "core/smoother/window.h"

namespace leonav {

// The weight factor is IGG-III of the residual over the measurement's sigma (core/robust/igg3.h).
//
// The filter tests each measurement against the prediction from all *other* ones. Over a window,
// and iterated, that test would let four or five satellites outvote each other in turn, so that the
// residuals of the estimate itself are used here.
//
// For codes the factor is at most IGG-III of the mean residual of one satellite's codes over these
// epochs: a signal that is reflected for many seconds gives errors that are small one by one but of
// one sign. With n codes over times n dt, `T` the correlation time, v the variance of the errors
// that change and c of those that last, the variance of the mean is taken as
//   c + v / min(n, max(1, n dt / T))
class WindowWeights {
 public:
  // Weights of epochs older than `horizon_s` stay as they are. Errors of a code less than
  // `correlation_time_s` apart count as one; 0: means are not tested.
  WindowWeights(const RobustConfig& robust, double horizon_s, double correlation_time_s)
      : robust_(robust), horizon_s_(horizon_s), correlation_time_s_(correlation_time_s) {}

  // Decides the factors at the keyframes' estimates.
  //
  // In the `first` iteration, keyframes whose weights were not decided before keep the filter's
  // factors.
  void update_factors(bool first, const Eigen::Vector3d& lever_arm_b, Window* window);

 private:
  struct CodeMean {
    SatelliteId satellite;
    SignalCode code;
    int count = 0;
    double residuals = 0.0;       // sum, m
    double white_variance = 0.0;  // sum, m^2, of errors that change from one epoch to the next
    // sum, m^2, of errors that last: orbit, clock, modelled ionosphere
    double correlated_variance = 0.0;
    double ratio = 0.0;  // the mean over its sigma
  };
  void gather_means(const Window& window, int oldest);
  CodeMean* find_mean(SatelliteId satellite, SignalCode code);
  void reweigh(Keyframe* keyframe);

  RobustConfig robust_;
  double horizon_s_, correlation_time_s_;
  // Codes beyond the capacity are tested singly only.
  boost::container::static_vector<CodeMean, kMaxMeasurements> means_;
};

}  // namespace leonav
