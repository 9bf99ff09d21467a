#include "core/navigator/sequencer/internal/epoch_queue.h"

#include <algorithm>
#include <utility>

#include "core/navigator/sequencer/input_validation.h"

namespace leonav {

EpochQueue::EpochQueue() : held_(std::make_unique<RawEpoch>()) {
  for (auto& slot : pending_) slot = std::make_unique<RawEpoch>();
}

bool EpochQueue::is_known(GpsTime time) const {
  const auto end = pending_.begin() + static_cast<std::ptrdiff_t>(count_);
  return (time == last_time_ && !last_is_empty_) ||
         std::any_of(pending_.begin(), end, [&](const auto& slot) { return slot->time == time; });
}

std::size_t EpochQueue::insert(const RawEpoch& epoch) {
  before_last_inserted_ = std::exchange(last_inserted_, epoch.time);
  const std::size_t left_out = copy_valid_observations(epoch, pending_[count_].get());
  for (std::size_t i = count_; i > 0 && epoch.time < pending_[i - 1]->time; --i) {
    std::swap(pending_[i], pending_[i - 1]);
  }
  ++count_;
  return left_out;
}

void EpochQueue::remove_oldest() {
  std::rotate(pending_.begin(), pending_.begin() + 1,
              pending_.begin() + static_cast<std::ptrdiff_t>(count_));
  --count_;
}

bool EpochQueue::is_overdue() const {
  if (count_ > kMaxPendingEpochs) return true;
  if (count_ <= kMinPending) return false;
  const GpsTime newest = std::min(last_inserted_, before_last_inserted_);
  return nanoseconds_between(newest, pending_[0]->time) > kMaxImuLatencyNs;
}

GpsTime EpochQueue::newest_time() const {
  return count_ > 0 ? pending_[count_ - 1]->time : last_time_;
}

void EpochQueue::hold(const RawEpoch& epoch) {
  *held_ = epoch;
  has_held_ = true;
}

const RawEpoch& EpochQueue::release_held() {
  has_held_ = false;
  return *held_;
}

void EpochQueue::set_issued(GpsTime time, bool empty) {
  last_time_ = time;
  last_is_empty_ = empty;
  if (!empty) last_raw_time_ = time;
}

void EpochQueue::clear() {
  last_time_ = last_raw_time_ = last_inserted_ = before_last_inserted_ = GpsTime();
  last_is_empty_ = true;
  count_ = 0;
  has_held_ = false;
}

}  // namespace leonav
