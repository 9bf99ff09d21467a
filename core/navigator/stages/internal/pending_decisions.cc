#include "core/navigator/stages/internal/pending_decisions.h"

#include <algorithm>
#include <type_traits>

namespace leonav {
namespace {

// This is half of the mailbox, so that the slots of decided epochs are free long before they are
// used again.
constexpr std::size_t kMaxPending = kMaxMailboxEpochs / 2;

}  // namespace

PendingDecisions::PendingDecisions(TimedMailbox<Anchor>* filter_mailbox,
                                   TimedMailbox<SmootherAnchor>* smoother_mailbox, OutputSink* sink,
                                   EventSource* events)
    : filter_mailbox_(filter_mailbox),
      smoother_mailbox_(smoother_mailbox),
      sink_(sink),
      events_(events),
      epochs_(kMaxPending) {}

std::optional<PendingEpoch> PendingDecisions::make_room() {
  if (!epochs_.full()) return std::nullopt;
  PendingEpoch oldest = epochs_.front();
  epochs_.pop_front();
  return oldest;
}

PendingEpoch* PendingDecisions::next_filter_due(GpsTime now) {
  for (PendingEpoch& epoch : epochs_)
    if (!epoch.filter_decided && epoch.issued.deadline_ekf <= now) return &epoch;
  return nullptr;
}

PendingEpoch* PendingDecisions::next_complete(GpsTime now) {
  if (epochs_.empty() || !epochs_.front().filter_decided) return nullptr;
  const GpsTime deadline = epochs_.front().issued.deadline_smoother;
  return deadline.is_set() && deadline > now ? nullptr : &epochs_.front();
}

GpsTime PendingDecisions::earliest_needed(GpsTime time) const {
  for (const PendingEpoch& epoch : epochs_) time = std::min(time, epoch.issued.time);
  return time;
}

bool PendingDecisions::take_filter(PendingEpoch* epoch, GpsTime now, Anchor* anchor) {
  epoch->filter_decided = true;
  const bool taken = take(filter_mailbox_, Decision::Subject::kFilter, epoch->issued, now, anchor);
  if (!taken) ++misses_;
  return taken;
}

bool PendingDecisions::take_smoother(PendingEpoch* epoch, GpsTime now, SmootherAnchor* anchor) {
  const bool taken =
      take(smoother_mailbox_, Decision::Subject::kSmoother, epoch->issued, now, anchor);
  if (!taken) ++smoother_misses_;
  return taken;
}

template <typename Result>
bool PendingDecisions::take(TimedMailbox<Result>* mailbox, Decision::Subject subject,
                            const EpochIssued& epoch, GpsTime now, Result* result) {
  Decision decision;
  decision.sequence = next_decision_++;
  decision.epoch = epoch.index;
  decision.time = now;
  decision.subject = subject;
  decision.committed = mailbox->take(epoch.index, result);
  if constexpr (std::is_same_v<Result, SmootherAnchor>) decision.iterations = result->iterations;
  sink_->on_decision(decision);
  if (!decision.committed)
    events_->emit(EventKind::kDeadlineMiss, static_cast<std::uint8_t>(subject),
                  static_cast<double>(epoch.index), now);
  return decision.committed;
}

void PendingDecisions::invalidate_issued() {
  if (!epochs_.empty()) last_invalid_epoch_ = epochs_.back().issued.index;
}

}  // namespace leonav
