// AnchorPropagation carries the state and covariance of an anchor forward with the IMU samples.
#pragma once
#include <Eigen/Core>
#include <boost/circular_buffer.hpp>
#include <cstdint>

#include "core/inertial/strapdown/mechanization.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/solution_conversion.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

// With attitude the state follows by strapdown mechanization, without (aligning) at constant
// velocity. Short holes in the IMU stream are filled as in the filter
// (core/inertial/strapdown/imu_gap_fill.h), longer ones at constant velocity and attitude with
// grown sigma. The samples since the anchor are kept, so that a newer anchor, which is of an
// earlier time than the newest sample, can be propagated over them again. Allocates when
// constructed, not after.
class AnchorPropagation {
 public:
  // `config`: copied.
  explicit AnchorPropagation(const NavigatorConfig& config);

  bool has_anchor() const { return anchor_.valid; }
  const Anchor& anchor() const { return anchor_; }

  // The next sample; when the store is full, the oldest sample is discarded.
  void add_sample(const ImuSample& sample);
  // Samples after `time` have been discarded because the store was full.
  bool has_discarded_after(GpsTime time) const;
  // Goes on from `anchor`, over all samples since. `needed_from`: an anchor yet to come may be as
  // early as this; samples before it are removed.
  void restart_from(const Anchor& anchor, GpsTime needed_from);
  void clear_anchor();
  void clear_samples();

  // At the end of the newest sample, `now`; there must be an anchor.
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
  ImuSample last_sample_;    // before the mechanization's time
  double unfilled_s_ = 0.0;  // of constant velocity since the anchor
  double gap_angle_variance_ = 0.0, gap_velocity_variance_ = 0.0;  // of filled gaps since then
};

}  // namespace leonav
