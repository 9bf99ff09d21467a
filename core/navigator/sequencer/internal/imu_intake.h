// ImuIntake turns received IMU samples into one stream of accepted samples in body axes.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/inertial/strapdown/imu.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/sequencer/internal/frozen_imu_monitor.h"
#include "core/navigator/sequencer/internal/imu_timeline.h"
#include "core/navigator/sequencer/internal/stamp_decision.h"
#include "core/navigator/sequencer/internal/time_step_monitor.h"

namespace leonav {

// Call for each sample, in this order: shift_stamp(), check(), release_held(), leaps(); then hold()
// if it leaps, else evaluate_stamp(), lay_on_timeline(), accept(), rotate_to_body(). A sample that
// release_held() returns is either refused or goes through the last four as well, ahead of the new
// one. The caller counts, reports and restarts in between.
class ImuIntake {
 public:
  static constexpr std::int64_t kLeapNs = 200'000'000;       // twice the longest interval
  static constexpr std::int64_t kMaxStepNs = 1'000'000'000;  // longest step in a run in a new time
  static constexpr double kMaxRotationRate = 35.0;    // rad/s, twice the range of a vehicle's IMU
  static constexpr double kMaxSpecificForce = 500.0;  // m/s^2
  static constexpr std::int64_t kMaxIntervalNs = 100'000'000;
  static constexpr int kRunToRestart = 20;  // samples that must agree on a new time
  // A distrusted IMU's samples must agree for so long without an epoch, or for so many epoch
  // intervals where that is longer.
  static constexpr std::int64_t kDistrustedRunNs = 10'000'000'000;
  static constexpr double kDistrustedIntervals = 2.5;

  explicit ImuIntake(const NavigatorConfig& config);

  // Returns the sample with the configured time offset added to its stamp. An impossible stamp
  // stays as it is: the offset must not make it a possible one, and its sum may not exist.
  ImuSample shift_stamp(const ImuSample& received) const;
  // Checks the values of the sample, whatever its stamp; kNotSane also for a sensor that is frozen.
  InputFault check(const ImuSample& sample);

  // Returns whether the stamp lies so far ahead that it follows a gap or is wrong. The next sample
  // decides which.
  bool leaps(const ImuSample& sample) const;
  void hold(const ImuSample& sample) { held_ = sample; }
  // Returns the held sample and ends its hold; nullopt: none was held.
  std::optional<ImuSample> release_held();

  // Decides whether the stamp fits the stream so far and the epochs. `newest_epoch` may be unset;
  // `max_epoch_ahead_ns` is how far an epoch may lie ahead of the sample, and `max_offset_ns` how
  // far a distrusted IMU may be from it either way.
  StampDecision evaluate_stamp(const ImuSample& sample, GpsTime newest_epoch,
                               std::int64_t max_epoch_ahead_ns, std::int64_t max_offset_ns);
  // Moves the sample to its time on the timeline, unless the timeline refuses it.
  ImuTimeline::Placement lay_on_timeline(ImuSample* sample) {
    return timeline_.place(time_, sample);
  }
  // Records that the sample was accepted.
  void accept(const ImuSample& sample);
  // Rotates the increments from IMU axes to body axes.
  void rotate_to_body(ImuSample* sample) const;

  // Returns the end of the last accepted sample; may be unset.
  GpsTime time() const { return time_; }
  // Removes everything, after a time step.
  void clear();
  // Notes that epochs have contradicted the time of this IMU and are followed. Until one of its
  // samples is accepted, it can change the time only where epochs have stopped; tell it of each
  // accepted epoch by add_epoch().
  void distrust() { distrusted_ = true; }
  void add_epoch() {
    if (distrusted_) time_monitor_.clear();
  }

 private:
  Eigen::Matrix3d C_b_imu_;  // IMU axes to body axes
  bool mounting_is_identity_;
  std::int64_t offset_ns_;   // is added to the stamps
  FrozenImuMonitor frozen_;  // outlives a time step
  ImuTimeline timeline_;
  TimeStepMonitor time_monitor_{kRunToRestart, kMaxStepNs};
  std::int64_t distrusted_run_ns_;
  bool distrusted_ = false;
  std::optional<ImuSample> held_;
  GpsTime time_;
};

}  // namespace leonav
