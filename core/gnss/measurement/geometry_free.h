// This unit follows the geometry-free combination, first minus second carrier, which contains only
// ionosphere and ambiguities.
#pragma once
#include <Eigen/Core>

namespace leonav {

// 1 sigma values, in metres of the combination.
struct GeometryFreeNoise {
  double value_m = 0.003;          // white, of one epoch
  double rate_m_s = 0.0005;        // of the rate before any is observed
  double rate_walk_m_s = 0.00002;  // growth of the rate's uncertainty per sqrt(s)
};

// Follows value and rate by a Kalman filter of two states whose rate is a random walk, so that
// intervals of any length, gaps and the first epochs of an arc have the right uncertainty. The
// innovations scale the white noise up or down.
class GeometryFreeTrend {
 public:
  struct Innovation {
    double value_m = 0.0;
    double sigma_m = 0.0;
  };

  // Begins a new arc. The rate is the ionosphere's and outlives the ambiguity: it is kept with
  // `keep_rate`, unless it is based on so few epochs that it may itself have ended the arc before.
  // `interval_s` is the time since the last update.
  void start(double value_m, double interval_s, const GeometryFreeNoise& noise, bool keep_rate);

  // Returns the innovation of a value `interval_s` after the last update.
  Innovation innovation(double value_m, double interval_s, const GeometryFreeNoise& noise) const;
  void update(double value_m, double interval_s, const GeometryFreeNoise& noise);
  // Propagates over `interval_s` without a value.
  void skip(double interval_s, const GeometryFreeNoise& noise);

 private:
  void learn_scale(const Innovation& seen);

  double value_m_ = 0.0, rate_m_s_ = 0.0;
  Eigen::Matrix2d covariance_ = Eigen::Matrix2d::Zero();
  double scale_squared_ = 1.0;  // of the white noise, running mean of squared innovations
  int updates_ = 0;             // since the start, bounded
};

}  // namespace leonav
