// PendingDecisions keeps the issued epochs until each mailbox has been read at its deadline.
#pragma once
#include <boost/circular_buffer.hpp>
#include <cstdint>
#include <optional>

#include "core/navigator/interface/event_source.h"
#include "core/navigator/interface/stage_work.h"
#include "core/navigator/interface/timed_mailbox.h"

namespace leonav {

// An issued epoch whose decisions have not all been made.
struct PendingEpoch {
  EpochIssued issued;
  bool filter_decided = false;
  Anchor held;  // valid: the filter's anchor waits for the smoother's deadline
};

// PendingDecisions makes a decision by taking an epoch's result from a mailbox: it is committed or
// a miss. It reports each decision to the sink, and a miss also as an event. The caller asks which
// decision is due, makes it, and uses the result. Allocates when constructed, not after.
class PendingDecisions {
 public:
  // `events` belongs to the stage that decides. All pointers must outlive this object.
  PendingDecisions(TimedMailbox<Anchor>* filter_mailbox,
                   TimedMailbox<SmootherAnchor>* smoother_mailbox, OutputSink* sink,
                   EventSource* events);

  // Removes and returns the oldest epoch if there is no room for another one. Call it before
  // push(), and make its decisions.
  std::optional<PendingEpoch> make_room();
  void push(const EpochIssued& issued) { epochs_.push_back({issued, false, {}}); }

  // Returns the oldest epoch whose filter's deadline has come and is not decided; nullptr: none.
  PendingEpoch* next_filter_due(GpsTime now);
  // Returns the oldest epoch if its filter is decided and the smoother's deadline has come, or
  // there is none; else nullptr. Make that decision, then call pop().
  PendingEpoch* next_complete(GpsTime now);
  // Returns the oldest epoch, whatever its deadlines; nullptr: there is none.
  PendingEpoch* oldest() { return epochs_.empty() ? nullptr : &epochs_.front(); }
  // Removes the oldest epoch.
  void pop() { epochs_.pop_front(); }
  // Returns the earliest time of an undecided epoch, or `time` if that is earlier.
  GpsTime earliest_needed(GpsTime time) const;

  // These decide at `now`. True: the result is committed and in *anchor. False: a miss.
  bool take_filter(PendingEpoch* epoch, GpsTime now, Anchor* anchor);
  bool take_smoother(PendingEpoch* epoch, GpsTime now, SmootherAnchor* anchor);

  // Marks the epochs issued so far as invalid, after a restart: they are decided as usual, but give
  // no anchor.
  void invalidate_issued();
  bool is_invalid(const PendingEpoch& epoch) const {
    return epoch.issued.index <= last_invalid_epoch_;
  }

  std::uint64_t misses() const { return misses_; }
  std::uint64_t smoother_misses() const { return smoother_misses_; }

 private:
  template <typename Result>
  bool take(TimedMailbox<Result>* mailbox, Decision::Subject subject, const EpochIssued& epoch,
            GpsTime now, Result* result);

  TimedMailbox<Anchor>* filter_mailbox_;
  TimedMailbox<SmootherAnchor>* smoother_mailbox_;
  OutputSink* sink_;
  EventSource* events_;
  boost::circular_buffer<PendingEpoch> epochs_;
  std::uint64_t last_invalid_epoch_ = 0;
  std::uint64_t misses_ = 0, smoother_misses_ = 0, next_decision_ = 1;
};

}  // namespace leonav
