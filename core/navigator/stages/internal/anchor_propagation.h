// AnchorPropagation propagates the state and covariance of an anchor with the IMU samples.
#pragma once
#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <cstdint>

#include "core/inertial/strapdown/mechanization.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/solution_conversion.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

// With attitude the state is propagated by strapdown mechanization, without (aligning) at constant
// velocity. Short gaps in the IMU stream are filled as in the filter
// (core/inertial/strapdown/imu_gap_fill.h). Over longer ones velocity and attitude stay constant
// and the sigmas grow. The samples since the anchor are kept: a newer anchor is earlier than the
// newest sample and is propagated over them again. Allocates when constructed, not after.
class AnchorPropagation {
 public:
  // Copies what it needs of `config`.
  explicit AnchorPropagation(const NavigatorConfig& config);

  bool has_anchor() const { return anchor_.valid; }
  const Anchor& anchor() const { return anchor_; }

  // Adds the next sample; when the store is full, the oldest sample is discarded.
  void add_sample(const ImuSample& sample);
  // Returns whether samples after `time` have been discarded because the store was full.
  bool has_discarded_after(GpsTime time) const;
  // Continues from `anchor`, over all samples since then. Samples before `needed_from` are removed;
  // a later anchor may be as early as that.
  void restart_from(const Anchor& anchor, GpsTime needed_from);
  void clear_anchor();
  void clear_samples();

  // Returns the time of the state: with attitude that of the anchor or, if it is later, of the
  // newest sample's end; without attitude `now`. Precondition: there is an anchor.
  GpsTime time(GpsTime now) const {
    return anchor_.has_attitude ? mechanization_.state().time : now;
  }
  // These return state and covariance at time(now). Precondition: there is an anchor.
  NavState state(GpsTime now) const;
  PvaCovariance covariance(GpsTime now) const;

 private:
  void remove_samples_before(GpsTime time);
  void step(const ImuSample& sample);
  void fill_gap(const ImuSample& next);

  ImuErrorModel imu_errors_;
  double acceleration_noise_;                  // (m/s^2)/sqrt(Hz), horizontal, without attitude
  boost::circular_buffer<ImuSample> samples_;  // since the anchor
  Mechanization mechanization_;
  Anchor anchor_;            // valid: there is one
  ImuSample last_sample_;    // the last one up to the mechanization's time
  double unfilled_s_ = 0.0;  // length of unfilled gaps since the anchor
  // Variances from filled gaps since the anchor, rad^2 and (m/s)^2 per axis.
  double gap_angle_variance_ = 0.0, gap_velocity_variance_ = 0.0;
};

}  // namespace leonav
