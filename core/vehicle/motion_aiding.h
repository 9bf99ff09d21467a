// MotionAiding predicts the filter over a block of IMU samples and applies the motion constraints
// on the way.
//
// Constraints are non-holonomic motion, zero velocity, zero angular rate and the odometer
// (core/filter/update/motion_constraint.h; Groves 2013, 15.1).
#pragma once
#include <optional>
#include <span>

#include "core/filter/ekf.h"
#include "core/inertial/strapdown/imu_error_model.h"
#include "core/vehicle/constraint_monitor.h"
#include "core/vehicle/constraint_report.h"
#include "core/vehicle/internal/odometer_aiding.h"
#include "core/vehicle/motion_aiding_config.h"
#include "core/vehicle/standstill_detector.h"

namespace leonav {

// MotionAiding applies the constraints at multiples of a fixed interval of GPS time, regardless of
// where the blocks begin, so that a replay meets the same instants.
class MotionAiding {
 public:
  // `accel_bias` is that of the IMU, m/s^2; `carriers` states whether the filter tracks carrier
  // phases.
  MotionAiding(const MotionAidingConfig& config, const GaussMarkov& accel_bias, bool carriers);

  // Resets everything after the filter has started over; time may begin anew.
  void reset();
  // Predicts like Ekf::predict. `odometer` holds the increments that came with the block, in order
  // of time.
  void predict(std::span<const ImuSample> block, std::span<const OdometerIncrement> odometer,
               GpsTime time, Ekf* ekf);
  // Sets how many satellites the last epoch used. With few, no majority excludes a reflected
  // signal, and the filter's velocity is worse than its sigma: the detector then requires more for
  // a stop to begin.
  void set_satellites_used(int used) { few_satellites_ = used < kEnoughSatellites; }
  // Returns whether a standstill also requires the carriers' agreement. That is so for an IMU whose
  // bias changes as fast as the velocity of a gentle start.
  bool requires_carrier_speed() const { return requires_carrier_speed_; }
  // Sets the horizontal speed, m/s, at the last epoch with satellites; nullopt: not known.
  void set_carrier_speed(std::optional<double> speed) { carrier_speed_ = speed; }
  // Returns the reports of the last predict().
  const ConstraintReports& reports() const { return reports_; }
  // Returns the instants since the last clear_instants(), up to their capacity.
  const ConstraintInstants& instants() const { return instants_; }
  // Returns whether no instant was dropped for lack of capacity.
  bool instants_complete() const { return instants_complete_; }
  void clear_instants();
  // Returns, once, that the filter leaves the constraints out most of the time.
  std::optional<ConstraintMonitor::Contradiction> contradiction() {
    return constraint_monitor_.contradiction();
  }

 private:
  static constexpr int kEnoughSatellites = 5;  // as many as unknowns of a velocity, and one more
  bool enabled() const { return config_.enabled() || odometer_.received(); }
  bool carriers_agree() const;
  void constrain(Ekf* ekf);
  void report(GpsTime time);

  MotionAidingConfig config_;
  StandstillDetector detector_;
  OdometerAiding odometer_;
  ConstraintInstants instants_;
  MotionMeasurements measurements_;
  ConstraintReports reports_;
  GpsTime next_;
  ConstraintMonitor constraint_monitor_;
  bool requires_carrier_speed_ = false;
  std::optional<double> carrier_speed_;
  bool standing_ = false, few_satellites_ = true, instants_complete_ = true;
};

}  // namespace leonav
