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

}  // namespace

GnssRing::GnssRing(Wakeup* consumer)
    : heads_(kHeads),
      observations_(kObservations),
      samples_(kSamples),
      increments_(kIncrements),
      precise_states_(kPreciseStates),
      corrected_states_(kCorrectedStates),
      biases_(kBiases),
      work_(std::make_unique<GnssWork>()),
      consumer_(consumer) {}

void GnssRing::push(const GnssWork& work) {
  if (!try_push(work)) {
    waits_.fetch_add(1, std::memory_order_relaxed);
    Backoff backoff;
    do {
      consumer_->notify();
      backoff.pause();
    } while (!try_push(work));
  }
  const std::uint64_t filled = filled_percent();
  if (filled > high_water_percent_.load(std::memory_order_relaxed))
    high_water_percent_.store(filled, std::memory_order_relaxed);
  work_counter_.push();
  consumer_->notify();
}

// The head comes last: once the consumer sees it, its lists are there.
bool GnssRing::try_push(const GnssWork& work) {
  if (!has_room_for(work)) return false;
  const Head head = std::visit(
      [this](const auto& one) -> Head {
        using Work = std::decay_t<decltype(one)>;
        if constexpr (std::is_same_v<Work, EpochWork>) {
          observations_.push(one.raw.observations);
          samples_.push(one.block);
          increments_.push(one.odometer);
          return EpochHead{one.index,
                           one.time,
                           one.raw.time,
                           one.empty,
                           one.smoother_decided,
                           one.raw.observations.size(),
                           one.block.size(),
                           one.odometer.size()};
        } else if constexpr (kIsList<Work>) {
          elements_of(one).push(one);
          return ListHead<Work>{one.size()};
        } else {
          return one;
        }
      },
      work);
  heads_.push(head);
  return true;
}

bool GnssRing::has_room_for(const GnssWork& work) const {
  if (heads_.write_available() == 0) return false;
  if (const auto* epoch = std::get_if<EpochWork>(&work))
    return observations_.has_room_for(epoch->raw.observations) &&
           samples_.has_room_for(epoch->block) && increments_.has_room_for(epoch->odometer);
  if (const auto* states = std::get_if<PreciseStates>(&work))
    return precise_states_.has_room_for(*states);
  if (const auto* states = std::get_if<CorrectedStates>(&work))
    return corrected_states_.has_room_for(*states);
  if (const auto* biases = std::get_if<SignalBiases>(&work)) return biases_.has_room_for(*biases);
  return true;
}

bool GnssRing::pop(GnssWork* work) {
  return heads_.consume_one([this, work](const Head& head) {
    std::visit(
        [this, work](const auto& one) {
          using One = std::decay_t<decltype(one)>;
          if constexpr (std::is_same_v<One, EpochHead>) {
            auto& epoch = work->template emplace<EpochWork>();
            epoch.index = one.index;
            epoch.time = one.time;
            epoch.raw.time = one.raw_time;
            epoch.empty = one.empty;
            epoch.smoother_decided = one.smoother_decided;
            observations_.pop(one.observations, &epoch.raw.observations);
            samples_.pop(one.samples, &epoch.block);
            increments_.pop(one.increments, &epoch.odometer);
          } else if constexpr (std::is_same_v<One, ListHead<PreciseStates>>) {
            precise_states_.pop(one.size, &work->template emplace<PreciseStates>());
          } else if constexpr (std::is_same_v<One, ListHead<CorrectedStates>>) {
            corrected_states_.pop(one.size, &work->template emplace<CorrectedStates>());
          } else if constexpr (std::is_same_v<One, ListHead<SignalBiases>>) {
            biases_.pop(one.size, &work->template emplace<SignalBiases>());
          } else {
            *work = one;
          }
        },
        head);
  });
}

std::uint64_t GnssRing::filled_percent() const {
  const std::uint64_t heads = 100 * (kHeads - heads_.write_available()) / kHeads;
  return std::max({heads, observations_.filled_percent(), samples_.filled_percent(),
                   increments_.filled_percent(), precise_states_.filled_percent(),
                   corrected_states_.filled_percent(), biases_.filled_percent()});
}

}  // namespace leonav
