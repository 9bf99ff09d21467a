#include "core/navigator/sequencer/internal/imu_intake.h"

#include <algorithm>
#include <utility>

#include "core/base/duration.h"
#include "core/earth/rotation.h"
#include "core/navigator/sequencer/input_validation.h"
#include "core/navigator/sequencer/internal/interval.h"

namespace leonav {
namespace {

// Returns whether the sample ends more than `limit_ns` before `time`, which may be unset.
bool is_behind(const ImuSample& sample, GpsTime time, std::int64_t limit_ns) {
  return time.is_set() && nanoseconds_between(time, sample.time) > limit_ns;
}

}  // namespace

ImuIntake::ImuIntake(const NavigatorConfig& config)
    : C_b_imu_(
          rotation_from_euler({config.vehicle.mounting_rpy.x(), config.vehicle.mounting_rpy.y(),
                               config.vehicle.mounting_rpy.z()})),
      mounting_is_identity_(config.vehicle.mounting_rpy.isZero(0.0)),
      offset_ns_(rounded_nanoseconds(config.imu_time_offset_s)),
      distrusted_run_ns_(std::max(
          kDistrustedRunNs,
          interval_in_nanoseconds(kDistrustedIntervals * config.realtime.epoch_interval_s))) {}

ImuSample ImuIntake::shift_stamp(const ImuSample& received) const {
  ImuSample sample = received;
  if (is_plausible(received.time)) sample.time = received.time.plus_nanoseconds(offset_ns_);
  return sample;
}

InputFault ImuIntake::check(const ImuSample& sample) {
  const ImuLimits limits{kMaxRotationRate, kMaxSpecificForce, kMaxIntervalNs};
  const InputFault fault = leonav::check(sample, limits);
  if (fault != InputFault::kNone) return fault;
  return frozen_.add(sample) ? InputFault::kNotSane : InputFault::kNone;
}

bool ImuIntake::leaps(const ImuSample& sample) const {
  const GpsTime last_stamp = timeline_.last_stamp();
  if (!last_stamp.is_set()) return false;
  const std::int64_t ahead_ns = nanoseconds_between(sample.time, last_stamp);
  return ahead_ns > kLeapNs && ahead_ns <= kMaxStampAheadNs;
}

std::optional<ImuSample> ImuIntake::release_held() { return std::exchange(held_, std::nullopt); }

StampDecision ImuIntake::evaluate_stamp(const ImuSample& sample, GpsTime newest_epoch,
                                        std::int64_t max_epoch_ahead_ns,
                                        std::int64_t max_offset_ns) {
  const GpsTime last_stamp = timeline_.last_stamp();
  if (last_stamp.is_set() && sample.time == last_stamp) return {InputFault::kDuplicate};
  const std::int64_t behind_ns = distrusted_ ? max_offset_ns : max_epoch_ahead_ns;
  const std::int64_t ahead_ns = distrusted_ ? max_offset_ns : kMaxStampAheadNs;
  const bool behind_others =
      is_behind(sample, newest_epoch, behind_ns) || is_behind(sample, time_, kMaxStampAheadNs);
  const bool backwards = behind_others || !timeline_.follows(sample);
  const bool ahead =
      (last_stamp.is_set() || distrusted_) &&
      nanoseconds_between(sample.time, std::max(last_stamp, newest_epoch)) > ahead_ns;
  if (!backwards && !ahead) return {};
  const bool is_run = time_monitor_.reject(sample.time);
  if (!is_run || (distrusted_ && time_monitor_.run_ns() < distrusted_run_ns_)) {
    return {backwards ? InputFault::kTimeBackwards : InputFault::kTooFarAhead};
  }
  const GpsTime old = last_stamp.is_set() ? last_stamp : newest_epoch;
  return {InputFault::kNone, true, seconds_between(sample.time, old)};
}

void ImuIntake::accept(const ImuSample& sample) {
  time_monitor_.clear();
  distrusted_ = false;
  time_ = sample.time;
}

void ImuIntake::rotate_to_body(ImuSample* sample) const {
  if (mounting_is_identity_) return;
  sample->delta_theta_b = C_b_imu_ * sample->delta_theta_b;
  sample->delta_velocity_b = C_b_imu_ * sample->delta_velocity_b;
}

void ImuIntake::clear() {
  time_ = GpsTime();
  timeline_.clear();
  held_.reset();
  time_monitor_.clear();
}

}  // namespace leonav
