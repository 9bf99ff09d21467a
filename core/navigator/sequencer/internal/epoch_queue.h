// EpochQueue keeps the raw GNSS epochs that wait for their IMU samples, in order of time.
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "core/base/capacity.h"
#include "core/gnss/signals/observation.h"
#include "core/navigator/sequencer/internal/stamp_decision.h"
#include "core/navigator/sequencer/internal/time_step_monitor.h"

namespace leonav {

// EpochQueue also keeps the time of the last issued epoch, which decides whether an epoch is late
// or a duplicate, and one epoch whose leap in time is not confirmed yet. Allocates when
// constructed, not after.
class EpochQueue {
 public:
  // An epoch may be this many epoch intervals ahead, where that is more than kMaxStampAheadNs.
  static constexpr double kMaxAheadIntervals = 3.0;
  static constexpr double kMaxStepS = 3600.0;  // longest interval in a run of epochs in a new time
  static constexpr int kRunToRestart = 5;      // epochs that must agree on a new time
  // Where the IMU has kept time, a run must be longer than the silence of the IMU over which the
  // inertial answer goes on: at least so many epochs, and more than such a silence has.
  static constexpr int kRunWithImu = 12;
  static constexpr std::int64_t kImuSilenceNs = 10'000'000'000;
  // The oldest epoch is overdue if more than kMinPending epochs wait and the newest is more than
  // kMaxImuLatencyNs later.
  static constexpr std::size_t kMinPending = 4;
  static constexpr std::int64_t kMaxImuLatencyNs = 2'000'000'000;
  // How long a run of late epochs must be before it contradicts the time they are late in.
  static constexpr std::int64_t kLateRunNs = 3'000'000'000;

  explicit EpochQueue(double epoch_interval_s);

  // Returns by how much IMU and newest epoch differ at most while both are right: GNSS may be late,
  // and the next epoch is an interval away.
  std::int64_t max_imu_offset_ns() const { return max_imu_offset_ns_; }
  // Decides whether the stamp of an epoch fits. `imu_time` is the end of the last accepted IMU
  // sample; may be unset. A late epoch passes here; is_late() finds it. While no epoch has
  // confirmed the IMU's time, kRunToRestart epochs suffice to contradict it: those that are
  // rejected, and then those that are older than the newest one, although no longer by too much.
  StampDecision evaluate(GpsTime time, GpsTime imu_time);
  // Returns how far an epoch may lie ahead of everything seen, ns.
  std::int64_t max_ahead_ns() const { return max_ahead_ns_; }
  // Ends the run of rejected epochs, because an IMU sample or an epoch has fitted.
  void clear_rejected_run() { time_monitor_.clear(); }
  // Ends the run of late epochs, because one was in time.
  void clear_late_run() { late_monitor_.clear(); }
  // Records that an epoch has fitted the time of the IMU, until the next time step.
  void confirm_imu() { confirms_imu_ = true; }
  bool confirms_imu() const { return confirms_imu_; }
  bool is_late(GpsTime time) const { return time <= last_time_; }
  // Returns whether the stamp is so much later than the newest epoch that it is wrong or follows an
  // outage.
  bool leaps(GpsTime time) const;

  // Adds an epoch with its valid observations and returns how many were excluded. Precondition: at
  // most kMaxPendingEpochs wait. One more makes the oldest overdue.
  std::size_t insert(const RawEpoch& epoch);
  bool empty() const { return count_ == 0; }
  // Returns the oldest epoch waiting; the queue must not be empty.
  const RawEpoch& oldest() const { return *pending_[0]; }
  void remove_oldest();
  // Returns whether the oldest epoch has waited long enough: its IMU samples are late, or have
  // stopped.
  bool is_overdue() const;
  // Adds a late epoch to the run of late ones, and returns whether these show that the time in
  // which they are late is wrong. `imu_time` is unset where the IMU does not keep the time. Epochs
  // from which the IMU is too far contradict it: if an epoch has confirmed its time, as many as
  // change the time while it is silent. Those that fit it contradict wrong epochs, later ones,
  // which were issued before.
  bool add_late(GpsTime time, GpsTime imu_time);
  // Returns whether an IMU sample and an epoch are further apart than max_imu_offset_ns().
  bool are_apart(GpsTime imu_time, GpsTime epoch) const;
  // Returns the time of the newest epoch waiting, else of the last one issued; may be unset.
  GpsTime newest_time() const;

  // Holds one epoch apart until the next input confirms its stamp.
  void hold(const RawEpoch& epoch);
  bool has_held() const { return has_held_; }
  // Returns the held epoch and ends its hold; the reference is valid until the next hold().
  const RawEpoch& release_held();

  // Records the last issued epoch.
  void set_issued(GpsTime time, bool empty);
  // Records the start of the IMU stream, which counts as an epoch for the first empty one.
  void set_start(GpsTime time) { last_time_ = time; }
  // These return the times of the last issued epoch and of the last one that was not empty; they
  // may be unset.
  GpsTime last_time() const { return last_time_; }
  GpsTime last_raw_time() const { return last_raw_time_; }
  bool last_is_empty() const { return last_is_empty_; }

  // Removes everything, after a time step.
  void clear();

 private:
  bool is_known(GpsTime time) const;

  std::int64_t max_ahead_ns_, max_imu_offset_ns_;
  int run_with_imu_;
  TimeStepMonitor time_monitor_;
  TimeStepMonitor late_monitor_;                                          // of late epochs alone
  std::array<std::unique_ptr<RawEpoch>, kMaxPendingEpochs + 1> pending_;  // the first count_
  std::size_t count_ = 0;
  std::unique_ptr<RawEpoch> held_;  // meaningful while has_held_
  bool has_held_ = false;
  GpsTime imu_time_at_last_;  // at the last evaluate()
  GpsTime last_time_;         // of the last issued epoch, or where the IMU stream began
  GpsTime last_raw_time_;     // of the last issued epoch that was not empty
  bool last_is_empty_ = true;
  bool confirms_imu_ = false;
};

}  // namespace leonav
