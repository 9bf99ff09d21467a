// The EpochQueue keeps the raw GNSS epochs that wait for their IMU data, in order of time.
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "core/base/capacity.h"
#include "core/gnss/signals/observation.h"
#include "core/navigator/sequencer/internal/stamp_decision.h"
#include "core/navigator/sequencer/internal/time_step_monitor.h"

namespace leonav {

// It also holds the time of the last epoch issued, against which an epoch is late or known, and one
// epoch that came after an outage and is not confirmed yet. It allocates when constructed, not
// after.
class EpochQueue {
 public:
  static constexpr double kMaxAheadIntervals = 3.0;  // of epochs, where that is more than 10 s
  static constexpr double kMaxStepS = 3600.0;        // between epochs of a run in a new time
  static constexpr int kRunToRestart = 5;            // epochs that agree on a new time
  static constexpr std::size_t kMinPending = 4;
  static constexpr std::int64_t kMaxImuLatencyNs = 2'000'000'000;

  explicit EpochQueue(double epoch_interval_s);

  // `imu_time`: end of the last accepted IMU sample; may be unset. A late epoch is accepted here.
  StampDecision evaluate(GpsTime time, GpsTime imu_time);
  // The IMU keeps time, or the epoch fits: epochs rejected so far are no run towards a new time.
  void clear_rejected_run() { time_monitor_.clear(); }
  bool is_late(GpsTime time) const { return time <= last_time_; }
  // By so much later than the newest epoch that it may be wild, or come after an outage.
  bool leaps(GpsTime time) const;

  // Copies the epoch's valid observations in; returns how many were left out. There must be room
  // for one epoch beyond kMaxPendingEpochs, which is_overdue() reports.
  std::size_t insert(const RawEpoch& epoch);
  bool empty() const { return count_ == 0; }
  const RawEpoch& oldest() const { return *pending_[0]; }
  void remove_oldest();
  // The oldest epoch has waited long enough: its IMU data are late, or have stopped.
  bool is_overdue() const;
  // Of the epochs waiting, or else of the last one issued; may be unset.
  GpsTime newest_time() const;

  // One epoch is held apart until the next input confirms its stamp.
  void hold(const RawEpoch& epoch);
  bool has_held() const { return has_held_; }
  // The epoch held, from now on held no more; valid until the next hold().
  const RawEpoch& release_held();

  // The last epoch issued.
  void set_issued(GpsTime time, bool empty);
  // The IMU stream begins here; this counts as an epoch for the interval to the first empty one.
  void set_start(GpsTime time) { last_time_ = time; }
  GpsTime last_time() const { return last_time_; }          // may be unset
  GpsTime last_raw_time() const { return last_raw_time_; }  // of the last that was not empty
  bool last_is_empty() const { return last_is_empty_; }

  void clear();  // a new time has begun

 private:
  bool is_known(GpsTime time) const;

  std::int64_t max_ahead_ns_;
  TimeStepMonitor time_monitor_;
  std::array<std::unique_ptr<RawEpoch>, kMaxPendingEpochs + 1> pending_;  // the first count_
  std::size_t count_ = 0;
  std::unique_ptr<RawEpoch> held_;  // meaningful while has_held_
  bool has_held_ = false;
  GpsTime last_time_;      // of the last issued epoch, or where the IMU stream began
  GpsTime last_raw_time_;  // of the last issued epoch that was not empty
  bool last_is_empty_ = true;
};

}  // namespace leonav
