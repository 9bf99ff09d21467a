// The ImuIntake turns received IMU samples into one stream of accepted samples in body axes.
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/inertial/strapdown/imu.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/sequencer/internal/imu_timeline.h"
#include "core/navigator/sequencer/internal/stamp_decision.h"
#include "core/navigator/sequencer/internal/time_step_monitor.h"

namespace leonav {

// For each sample, in this order: shift_stamp(), check(), leaps() and hold(), evaluate_stamp(),
// lay_on_timeline(), accept(). The caller counts, reports and restarts in between.
class ImuIntake {
 public:
  static constexpr std::int64_t kLeapNs = 200'000'000;       // twice the longest interval
  static constexpr std::int64_t kMaxStepNs = 1'000'000'000;  // in a run in a new time
  static constexpr double kMaxRotationRate = 35.0;    // rad/s, twice what a vehicle's IMU measures
  static constexpr double kMaxSpecificForce = 500.0;  // m/s^2
  static constexpr std::int64_t kMaxIntervalNs = 100'000'000;
  static constexpr int kRunToRestart = 20;  // samples that agree on a new time

  explicit ImuIntake(const NavigatorConfig& config);

  // Adds the configured time offset to the stamp as received.
  ImuSample shift_stamp(const ImuSample& received) const;
  // Of the sample by itself, whatever came before it.
  static InputFault check(const ImuSample& sample);

  // The stamp lies so far ahead that it is a hole in the stream, or one wild stamp; the sample
  // after this one decides which.
  bool leaps(const ImuSample& sample) const;
  void hold(const ImuSample& sample) { held_ = sample; }
  std::optional<ImuSample> release_held();  // nullopt: none was held

  // Of the stamp against the stream so far. `newest_epoch`: may be unset.
  StampDecision evaluate_stamp(const ImuSample& sample, GpsTime newest_epoch);
  // Moves the sample to where it lies on the timeline, unless the timeline refuses it.
  ImuTimeline::Placement lay_on_timeline(ImuSample* sample) {
    return timeline_.place(time_, sample);
  }
  void accept(const ImuSample& sample);
  // Rotates the increments from IMU axes to body axes.
  void rotate_to_body(ImuSample* sample) const;

  GpsTime time() const { return time_; }  // end of the last accepted sample; may be unset
  void clear();                           // a new time has begun

 private:
  Eigen::Matrix3d C_b_imu_;  // IMU axes to body
  bool mounting_is_identity_;
  std::int64_t offset_ns_;  // to be added to the stamps
  ImuTimeline timeline_;
  TimeStepMonitor time_monitor_{kRunToRestart, kMaxStepNs};
  std::optional<ImuSample> held_;
  GpsTime time_;
};

}  // namespace leonav
