#include "drivers/rtcm3/epoch_assembly.h"

#include <algorithm>
#include <utility>

#include "core/base/calendar.h"
#include "drivers/binary/week_time.h"

namespace leonav {
namespace {

constexpr std::int64_t kMillisecondsPerWeek = kSecondsPerWeek * 1000;
constexpr std::int64_t kNanosecondsPerMillisecond = 1'000'000;
// A longer interval between epochs is a pause.
constexpr double kLongestInterval_s = 60.0;
// A station that may follow is given up after so many messages of further ones: more than an epoch
// has.
constexpr int kForgetOther = 16;

// GPS and Galileo count milliseconds of a week of GPS time, BeiDou of its own, 14 s behind.
GpsTime instant_of(System system, std::uint32_t epoch_ms, GpsTime near) {
  const std::int64_t offset_ms = system == System::kBeidou ? -1000 * kBeidouMinusGpsSeconds : 0;
  return nearest_instant_ns((epoch_ms + offset_ms) * kNanosecondsPerMillisecond, near);
}

}  // namespace

std::optional<GpsTime> EpochAssembly::begin(const MsmType& type,
                                            std::span<const std::uint8_t> message, GpsTime near) {
  more_follow_ = true;
  const std::optional<MsmHeader> header = read_msm_header(type, message);
  if (!header) {
    ++counters_.bad_length;
    return std::nullopt;
  }
  if (is_of_other_station(type, *header, near)) {
    ++counters_.other_station;
    return std::nullopt;
  }
  // The last message of an epoch may be one of a system that is not used.
  more_follow_ = header->more_follow;
  if (!type.system) return std::nullopt;
  if (!type.has_full_range()) {
    ++counters_.without_full_range;
    return std::nullopt;
  }
  if (header->epoch_ms >= kMillisecondsPerWeek) {
    ++counters_.bad_time;
    return std::nullopt;
  }
  if (!near.is_set()) {
    ++counters_.without_reference;
    return std::nullopt;
  }
  switch (read_msm(type, message, &message_)) {
    case MsmStatus::kOk:
      break;
    case MsmStatus::kBadLength:
      ++counters_.bad_length;
      return std::nullopt;
    case MsmStatus::kBadMask:
      ++counters_.bad_mask;
      return std::nullopt;
  }
  return instant_of(*type.system, header->epoch_ms, near);
}

// Times are compared only with those of the same sender, whose clock may be wrong.
bool EpochAssembly::is_of_other_station(const MsmType& type, const MsmHeader& header,
                                        GpsTime near) {
  const bool is_open = std::exchange(is_station_open_, false);
  if (station_ == header.station) {
    other_since_ = {};
    return false;
  }
  if (!is_open) {
    if (!type.system || header.epoch_ms >= kMillisecondsPerWeek || !near.is_set()) return true;
    if (!has_sent_alone(header.station, instant_of(*type.system, header.epoch_ms, near))) {
      return true;
    }
  }
  change_station(header.station);
  return false;
}

// One of several others is followed, so that the time of one does not count for another.
bool EpochAssembly::has_sent_alone(std::uint16_t station, GpsTime time) {
  const bool is_same = other_since_.is_set() && station == other_;
  if (!is_same && other_since_.is_set() && ++without_other_ < kForgetOther) return false;
  if (!is_same || time < other_since_) {
    other_ = station;
    other_since_ = time;
  }
  without_other_ = 0;
  return seconds_between(time, other_since_) >= std::max(kOtherStation_s, 3.0 * interval_s_);
}

// What is there of an epoch of the station before is given up, so that no epoch is of two.
void EpochAssembly::change_station(std::uint16_t station) {
  if (station_) {
    ++counters_.station_changes;
    counters_.station_before = *station_;
  }
  station_ = counters_.station = station;
  other_since_ = {};
  observations_.interrupt_carriers();
  clear();
}

bool EpochAssembly::add(std::optional<GpsTime> time) {
  if (time) {
    if (*time == last_given_) {
      count_late();
      return false;
    }
    epoch_.time = *time;
    ++counters_.messages;
    observations_.add(message_, *time, &signals_);
  }
  return epoch_.time.is_set() && !more_follow_ && !counters_.bit_is_wrong;
}

void EpochAssembly::count_late() {
  constexpr int kEnough = 2;
  ++counters_.late;
  if (went_on_) return;
  went_on_ = true;
  if (++gone_on_in_row_ == kEnough) counters_.bit_is_wrong = true;
}

// Returns whether the epoch has anything to give out.
bool EpochAssembly::complete() {
  if (last_given_.is_set()) {
    interval_s_ = std::min(seconds_between(epoch_.time, last_given_), kLongestInterval_s);
  }
  last_given_ = epoch_.time;
  if (!went_on_) gone_on_in_row_ = 0;
  went_on_ = false;
  if (signals_.empty()) {
    ++counters_.empty_epochs;
    return false;
  }
  capacity_.fit(&signals_, &epoch_);
  ++counters_.epochs;
  return true;
}

void EpochAssembly::clear() {
  epoch_.time = {};
  signals_.clear();
}

}  // namespace leonav
