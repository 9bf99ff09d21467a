// The robust weights of a window's measurements, decided together.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>

#include "core/gnss/igg3.h"
#include "core/smoother/window.h"

namespace leonav {

// IGG-III on each residual over the measurement's sigma. (The filter tests against the prediction
// from all *other* measurements. Over a window, iterated, that would let four or five satellites
// outvote each other in turn.) And on the mean residual of each satellite's codes: a signal that
// is reflected for many seconds gives errors that are small one by one but of one sign.
class WindowWeights {
 public:
  // `alike_s`: errors of a code nearer to each other than this count as one; 0: means are not
  // judged.
  WindowWeights(const RobustConfig& robust, double alike_s) : robust_(robust), alike_s_(alike_s) {}

  // At the keyframes' estimates. Those that were not judged yet keep the filter's factors at the
  // `first` iteration. Returns the largest change of a factor.
  double decide(bool first, const Eigen::Vector3d& lever_arm_b, Window* window);

 private:
  struct CodeMean {
    SatelliteId satellite;
    SignalCode code;
    int count = 0;
    double residuals = 0.0;  // sums: m
    double varying = 0.0;    // m^2, of what changes from one time to the next
    double lasting = 0.0;    // m^2, of what stays: orbit, clock, ionosphere by a model
    double ratio = 0.0;      // the mean over its sigma
  };
  void gather_means(const Window& window);
  CodeMean* find_mean(SatelliteId satellite, SignalCode code);
  double reweigh(Keyframe* keyframe);

  RobustConfig robust_;
  double alike_s_;
  // Codes beyond its capacity are judged one by one only.
  boost::container::static_vector<CodeMean, kMaxMeasurements> means_;
};

}  // namespace leonav
