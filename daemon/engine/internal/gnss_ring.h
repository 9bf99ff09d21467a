// The GnssRing is the queue of work from `io` to `gnss`.
#pragma once
#include <atomic>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <memory>
#include <variant>

#include "core/navigator/interface/stage_work.h"
#include "daemon/threads/wakeup.h"
#include "daemon/threads/work_ring.h"

namespace leonav {

// A WorkRing of heads, whose lists go through queues of their own: a GnssWork has room for the
// longest lists, of 137 kB, and few are as long. Between exactly two threads; a full queue makes
// the producer wait, which is counted, and nothing is dropped.
class GnssRing {
 public:
  explicit GnssRing(Wakeup* consumer);

  // Producer.
  void push(const GnssWork& work);

  // Consumer: calls use(work), then frees it. False: empty.
  template <typename Use>
  bool consume_one(Use&& use) {
    return heads_.consume_one([&](const Head& head) {
      unpack(head);
      use(*work_);
    });
  }

  // Any thread: everything that was pushed has been processed.
  bool idle() const { return heads_.idle(); }
  WorkCount count() const { return heads_.count(); }
  RingStatistics statistics() const;

 private:
  // The elements of one kind of list, of all work that waits.
  template <typename T>
  class Elements {
   public:
    explicit Elements(std::size_t capacity) : capacity_(capacity), queue_(capacity) {}
    template <typename List>
    bool has_room_for(const List& list) const {
      return queue_.write_available() >= list.size();
    }
    template <typename List>
    void push(const List& list) {
      queue_.push(list.data(), list.size());
    }
    template <typename List>
    void pop(std::size_t count, List* list) {
      list->resize(count);
      queue_.pop(list->data(), count);
    }
    std::uint64_t filled_percent() const {
      return 100 * (capacity_ - queue_.write_available()) / capacity_;
    }

   private:
    std::size_t capacity_;
    boost::lockfree::spsc_queue<T> queue_;
  };

  // Work without its lists.
  struct EpochHead {
    std::uint64_t index = 0;
    GpsTime time, raw_time;
    bool empty = false, smoother_decided = false;
    std::size_t observations = 0, samples = 0, increments = 0;
  };
  template <typename T>
  struct ListHead {
    using List = T;
    std::size_t size = 0;
  };
  using Head = std::variant<Ephemeris, ListHead<PreciseStates>, ListHead<CorrectedStates>,
                            ListHead<SignalBiases>, KlobucharModel, AntennaPattern, Command,
                            Checkpoint, EpochHead>;

  bool has_room_for_lists(const GnssWork& work) const;
  Head push_lists(const GnssWork& work);
  void unpack(const Head& head);  // into work_
  std::uint64_t lists_filled_percent() const;

  Elements<PreciseState>& elements_of(const PreciseStates&) { return precise_states_; }
  Elements<CorrectedState>& elements_of(const CorrectedStates&) { return corrected_states_; }
  Elements<SignalBias>& elements_of(const SignalBiases&) { return biases_; }
  const Elements<PreciseState>& elements_of(const PreciseStates&) const { return precise_states_; }
  const Elements<CorrectedState>& elements_of(const CorrectedStates&) const {
    return corrected_states_;
  }
  const Elements<SignalBias>& elements_of(const SignalBiases&) const { return biases_; }

  Elements<SignalObservation> observations_;
  Elements<ImuSample> samples_;
  Elements<OdometerIncrement> increments_;
  Elements<PreciseState> precise_states_;
  Elements<CorrectedState> corrected_states_;
  Elements<SignalBias> biases_;
  WorkRing<Head> heads_;
  std::unique_ptr<GnssWork> work_;  // the consumer's
  Wakeup* consumer_;
  std::atomic<std::uint64_t> waits_for_lists_{0}, lists_high_water_percent_{0};
};

}  // namespace leonav
