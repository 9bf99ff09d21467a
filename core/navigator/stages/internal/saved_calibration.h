// SavedCalibration starts the filter from what an earlier run has found out about errors, IMU and
// vehicle.
#pragma once
#include <array>
#include <optional>

#include "core/filter/ekf.h"
#include "core/inertial/alignment/alignment.h"
#include "core/navigator/interface/checkpoint.h"
#include "core/navigator/interface/navigator_config.h"

namespace leonav {

// Nothing of it is believed as it was. With the age a of the checkpoint
//   learned sizes of errors   count by exp(-a / 1 h) of their logarithm,
//   errors of the IMU         are moved on by their Gauss-Markov process,
//   vehicle constants         are moved on by their random walk;
// sigmas are doubled, and lie between a fifth of the configured one and that. The accelerometers'
// bias starts from zero all the same: the level is made of their specific force and contains it.
// Where an error is far beyond its configured sigma, this one's included, the IMU is another one,
// and nothing of the calibration is used. Where the gyros' bias was measured at rest, it is
// combined with the saved one; where they contradict each other, the IMU's errors are as
// configured.
class SavedCalibration {
 public:
  explicit SavedCalibration(const NavigatorConfig& config);

  struct Verdict {
    CheckpointUse use;
    double value;
  };
  // Takes a checkpoint, in place of one before.
  void take(const Checkpoint& checkpoint) {
    checkpoint_ = checkpoint;
    started_ = false;
  }
  // Call it where the filter starts, directly before Ekf::initialize(): gives the filter sizes of
  // errors and vehicle constants, once. A verdict says why the calibration is not used.
  std::optional<Verdict> start(GpsTime time, Ekf* filter);
  // Sets the first attitude, with the errors of the IMU as far as they are known; the checkpoint is
  // used up by this.
  std::optional<Verdict> set_attitude(const AlignedAttitude& aligned, GpsTime time, Ekf* filter);

 private:
  bool is_of_this_vehicle(const Calibration& calibration) const;
  double worst_imu_error(const Calibration& calibration) const;
  void start_constants(const Calibration& calibration, double age_s, Ekf* filter) const;

  ImuErrorModel imu_;
  VehicleConstantsConfig vehicle_constants_;
  Eigen::Vector3d mounting_rpy_;
  double max_age_s_;
  // What is configured of each vehicle constant; its estimate is beyond that.
  std::array<double, ekf_index::kMaxVehicle> configured_{};
  std::optional<Checkpoint> checkpoint_;
  bool started_ = false;
};

}  // namespace leonav
