// InertialPropagator moves a StateEstimate over a block of IMU samples.
#pragma once
#include <span>

#include "core/filter/estimate/speed_history.h"
#include "core/filter/estimate/state_estimate.h"
#include "core/filter/process/ins_transition.h"
#include "core/inertial/strapdown/imu.h"
#include "core/inertial/strapdown/mechanization.h"

namespace leonav {

// With attitude: strapdown mechanization (core/inertial/strapdown/mechanization.h) and the error
// equations of core/filter/process/ins_transition.h, the covariance once per sub-block of 24.5 ms.
// Short gaps in the IMU data are filled (imu_gap_fill.h), also across blocks; over longer ones, and
// without attitude, the estimate coasts at constant velocity. The filter and the smoother's
// repropagation use the same class.
class InertialPropagator {
 public:
  InertialPropagator(const EkfConfig& config, const ImuErrorModel& imu)
      : imu_(imu),
        averages_acceleration_(config.vehicle.moves_antenna()),
        is_static_(config.static_point) {}

  // Forgets the IMU samples.
  void reset();
  // Goes on from `nav`; `last_sample` was measured before (interval 0: none).
  void restart(const NavState& nav, const ImuSample& last_sample);
  // Keeps the last sample of a block that is not integrated, because there is no estimate yet.
  void remember(std::span<const ImuSample> block);

  // Predicts `estimate` over `block` to `time`; samples outside of that interval are skipped.
  // `speeds`, if given, receives the state after every sample. Returns false if the inertial
  // prediction was interrupted: IMU data were missing, and a gap was filled or coasted over.
  bool predict(std::span<const ImuSample> block, GpsTime time, StateEstimate* estimate,
               SpeedHistory* speeds = nullptr);

  const BodyMotion& body() const { return body_; }

 private:
  // These three return false if IMU data were missing for an inertial prediction.
  bool advance_to_sample(const ImuSample& sample, StateEstimate* estimate);
  bool fill_gap(GpsTime time, const ImuSample& next, StateEstimate* estimate);
  bool coast(GpsTime time, StateEstimate* estimate);
  void advance(const ImuSample& sample, StateEstimate* estimate);
  void begin_sub_block(const StateEstimate& estimate);
  void finish_sub_block(StateEstimate* estimate);
  void average_acceleration(const Eigen::Vector3d& change_e, double interval_s);

  ImuErrorModel imu_;
  bool averages_acceleration_;
  bool is_static_;
  Mechanization mechanization_;
  InsTransition transition_;
  ImuSample last_sample_;  // the last one measured, not one filled in; interval 0: none yet
  BodyMotion body_;
};

}  // namespace leonav
