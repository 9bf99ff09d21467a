// EpochQueue keeps the raw GNSS epochs that wait for their IMU samples, in order of time.
#pragma once
#include <array>
#include <cstdint>
#include <memory>

#include "core/base/capacity.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// EpochQueue also keeps the time of the last issued epoch, which decides whether an epoch is late
// or a duplicate, and one epoch whose leap in time is not confirmed yet. Whether stamps fit is
// decided by EpochStamps. Allocates when constructed, not after.
class EpochQueue {
 public:
  // The oldest epoch is overdue if more than kMinPending epochs wait and the two that came last are
  // more than kMaxImuLatencyNs later. Others with wrong stamps may be far ahead of these.
  static constexpr std::size_t kMinPending = 4;
  static constexpr std::int64_t kMaxImuLatencyNs = 2'000'000'000;

  EpochQueue();

  // Returns whether an epoch of this time waits or is the last one issued.
  bool is_known(GpsTime time) const;
  bool is_late(GpsTime time) const { return time <= last_time_; }

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
  std::array<std::unique_ptr<RawEpoch>, kMaxPendingEpochs + 1> pending_;  // the first count_
  std::size_t count_ = 0;
  std::unique_ptr<RawEpoch> held_;  // meaningful while has_held_
  bool has_held_ = false;
  GpsTime last_time_;      // of the last issued epoch, or where the IMU stream began
  GpsTime last_raw_time_;  // of the last issued epoch that was not empty
  GpsTime last_inserted_, before_last_inserted_;
  bool last_is_empty_ = true;
};

}  // namespace leonav
