// Predicts the filter over a block of IMU samples, held by what the vehicle's way of moving tells.
#pragma once
#include <boost/container/static_vector.hpp>
#include <optional>
#include <span>

#include "core/capacity.h"
#include "core/ekf/ekf.h"
#include "core/ins/imu_error_model.h"
#include "core/ins/standstill_detector.h"
#include "core/navigator/odometer_aid.h"
#include "core/navigator/outputs.h"

namespace leonav {

struct MotionAidConfig {
  MotionConstraintConfig constraints;
  StandstillConfig standstill;
  bool enabled() const { return constraints.non_holonomic || constraints.zero_velocity; }
};

// Constraints act at instants a fixed interval of GPS time apart, wherever a sample is, so that a
// replay meets the same ones.
class MotionAid {
 public:
  // `accel_bias`: of the IMU, m/s^2; `carriers`: whether the filter follows the satellites'.
  MotionAid(const MotionAidConfig& config, const GaussMarkov& accel_bias, bool carriers);

  // The filter starts over, and time may begin anew.
  void reset();
  // As Ekf::predict. `odometer`: the increments that came with the block, in order of time.
  void predict(std::span<const ImuSample> block, std::span<const OdometerIncrement> odometer,
               GpsTime time, Ekf* ekf);
  // How many satellites the last epoch used. With few, nobody outvotes a reflection, and the
  // filter's velocity is worse than its sigma: a stop that begins must show the more.
  void set_satellites(int used) { few_satellites_ = used < kEnoughSatellites; }
  // An IMU whose bias wanders as fast as one who creeps gathers speed cannot tell that one from one
  // who stands: then the carriers must agree.
  bool asks_carriers() const { return asks_carriers_; }
  // Horizontal, m/s, of the last epoch with satellites; nullopt: not known.
  void set_carrier_speed(std::optional<double> speed) { carrier_speed_ = speed; }
  // Of the last call of predict().
  const ConstraintReports& reports() const { return reports_; }
  // Since the last call of forget(); as many as have a place.
  const ConstraintInstants& instants() const { return instants_; }
  bool whole() const { return whole_; }  // none was left out for want of a place
  void forget();
  // When the gate has left something out at more than half of the last ten seconds' instants: the
  // vehicle slides, or is not what the configuration says. Told once; again after it was below a
  // quarter.
  struct Contradiction {
    double share = 0.0;             // of the instants
    MotionComponents left_out = 0;  // at the last of them that left something out
  };
  std::optional<Contradiction> contradiction();

 private:
  static constexpr int kEnoughSatellites = 5;
  bool enabled() const { return config_.enabled() || odometer_.heard(); }
  bool carriers_agree() const;
  void constrain(Ekf* ekf);
  void count(MotionComponents used);
  void report(GpsTime time);

  MotionAidConfig config_;
  StandstillDetector detector_;
  OdometerAid odometer_;
  ConstraintInstants instants_;
  MotionMeasurements measurements_;
  ConstraintReports reports_;
  GpsTime next_;
  double offered_ = 0.0, left_out_ = 0.0;  // fading
  MotionComponents last_left_out_ = 0;
  bool contradicted_ = false;
  bool asks_carriers_ = false;
  std::optional<double> carrier_speed_;
  bool standing_ = false, few_satellites_ = true, whole_ = true;
};

}  // namespace leonav
