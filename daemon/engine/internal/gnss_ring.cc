#include "daemon/engine/internal/gnss_ring.h"

#include <algorithm>
#include <type_traits>

#include "daemon/threads/backoff.h"

namespace leonav {
namespace {

constexpr std::size_t kHeads = 32;
// The longest list always has room. Beyond that: 32 epochs with 192 observations each, as of 64
// satellites with three signals, and 30 s of an IMU at 200 Hz.
constexpr std::size_t kObservations = 12 * kMaxObservations;
constexpr std::size_t kSamples = 4 * kMaxImuBlock;
constexpr std::size_t kIncrements = 4 * kMaxOdometerBlock;
constexpr std::size_t kPreciseStates = 4 * kMaxEphemerisSatellites;
constexpr std::size_t kCorrectedStates = 4 * kMaxCorrectedStates;
constexpr std::size_t kBiases = 2 * kMaxBiases;

template <typename T>
constexpr bool kIsList = std::is_same_v<T, PreciseStates> || std::is_same_v<T, CorrectedStates> ||
                         std::is_same_v<T, SignalBiases>;
template <typename T>
concept IsListHead = requires {
  typename T::List;
};

}  // namespace

GnssRing::GnssRing(Wakeup* consumer)
    : observations_(kObservations),
      samples_(kSamples),
      increments_(kIncrements),
      precise_states_(kPreciseStates),
      corrected_states_(kCorrectedStates),
      biases_(kBiases),
      heads_(kHeads, consumer),
      work_(std::make_unique<GnssWork>()),
      consumer_(consumer) {}

// The head comes last: once the consumer sees it, its lists are there.
void GnssRing::push(const GnssWork& work) {
  if (!has_room_for_lists(work)) {
    waits_for_lists_.fetch_add(1, std::memory_order_relaxed);
    Backoff backoff;
    do {
      consumer_->notify();
      backoff.pause();
    } while (!has_room_for_lists(work));
  }
  const Head head = push_lists(work);
  const std::uint64_t filled = lists_filled_percent();
  if (filled > lists_high_water_percent_.load(std::memory_order_relaxed))
    lists_high_water_percent_.store(filled, std::memory_order_relaxed);
  heads_.push(head);
}

bool GnssRing::has_room_for_lists(const GnssWork& work) const {
  return std::visit(
      [this](const auto& one) {
        using Work = std::decay_t<decltype(one)>;
        if constexpr (std::is_same_v<Work, EpochWork>)
          return observations_.has_room_for(one.raw.observations) &&
                 samples_.has_room_for(one.block) && increments_.has_room_for(one.odometer);
        else if constexpr (kIsList<Work>)
          return elements_of(one).has_room_for(one);
        else
          return true;
      },
      work);
}

GnssRing::Head GnssRing::push_lists(const GnssWork& work) {
  return std::visit(
      [this](const auto& one) -> Head {
        using Work = std::decay_t<decltype(one)>;
        if constexpr (std::is_same_v<Work, EpochWork>) {
          // Does not compile with a field more: it must go into the head, or a list, too.
          const auto& [index, time, empty, raw, block, odometer, smoother_decided] = one;
          const auto& [raw_time, observations] = raw;
          observations_.push(observations);
          samples_.push(block);
          increments_.push(odometer);
          return EpochHead{
              index,        time,           raw_time, empty, smoother_decided, observations.size(),
              block.size(), odometer.size()};
        } else if constexpr (kIsList<Work>) {
          elements_of(one).push(one);
          return ListHead<Work>{one.size()};
        } else {
          return one;
        }
      },
      work);
}

void GnssRing::unpack(const Head& head) {
  std::visit(
      [this](const auto& one) {
        using One = std::decay_t<decltype(one)>;
        if constexpr (std::is_same_v<One, EpochHead>) {
          auto& epoch = work_->template emplace<EpochWork>();
          epoch.index = one.index;
          epoch.time = one.time;
          epoch.raw.time = one.raw_time;
          epoch.empty = one.empty;
          epoch.smoother_decided = one.smoother_decided;
          observations_.pop(one.observations, &epoch.raw.observations);
          samples_.pop(one.samples, &epoch.block);
          increments_.pop(one.increments, &epoch.odometer);
        } else if constexpr (IsListHead<One>) {
          auto& list = work_->template emplace<typename One::List>();
          elements_of(list).pop(one.size, &list);
        } else {
          *work_ = one;
        }
      },
      head);
}

RingStatistics GnssRing::statistics() const {
  const RingStatistics heads = heads_.statistics();
  return {
      std::max(heads.high_water_percent, lists_high_water_percent_.load(std::memory_order_relaxed)),
      heads.waits + waits_for_lists_.load(std::memory_order_relaxed)};
}

std::uint64_t GnssRing::lists_filled_percent() const {
  return std::max({observations_.filled_percent(), samples_.filled_percent(),
                   increments_.filled_percent(), precise_states_.filled_percent(),
                   corrected_states_.filled_percent(), biases_.filled_percent()});
}

}  // namespace leonav
