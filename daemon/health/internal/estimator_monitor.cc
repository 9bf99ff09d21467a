#include "daemon/health/internal/estimator_monitor.h"

#include <utility>

#include "core/navigator/interface/solution.h"
#include "daemon/health/internal/counter_sums.h"
#include "daemon/text/reset_text.h"

namespace leonav {
namespace {

constexpr int kSettledLooks = 30;
// Looks. Wrong axes or stamps contradict epoch after epoch; reflected signals do so once.
constexpr std::int64_t kContradictions = 2;

}  // namespace

std::span<const Finding> EstimatorMonitor::look() {
  found_.clear();
  look_at_starts();
  look_at_jumps();
  looks_widened_ += widened_.look(counters_->widened_predictions.get()) ? 1 : 0;
  recently_widened_.look(looks_widened_);
  if (recently_widened_.get() >= kContradictions) found_.add(HealthReason::kPredictionWidened);
  if (improbable_.look(event_count(*counters_, EventKind::kImprobable)))
    found_.add(HealthReason::kImprobable);
  if (constraints_left_out_.look(event_count(*counters_, EventKind::kConstraintsLeftOut)))
    found_.add(HealthReason::kConstraintsLeftOut);
  return found_.get();
}

void EstimatorMonitor::look_at_starts() {
  const std::int64_t starts = counters_->filter_starts.get();
  if (std::exchange(starts_, starts) == starts) return;
  epochs_at_start_ = counters_->accepted_epochs.get();
  received_at_start_ = counters_->received[index_of(Channel::kGnssEpoch)].get();
  found_.add(HealthReason::kFilterStartedOver,
             reset_text(static_cast<ResetCause>(counters_->reset_cause.get())));
}

// While it begins, and after an outage, the solution jumps to where it belongs. After an outage its
// sigma says how far that may be.
void EstimatorMonitor::look_at_jumps() {
  const auto source = static_cast<Source>(counters_->source.get());
  const bool has_answer = source != Source::kNone && source != Source::kAligning;
  const bool has_gnss = has_answer && source != Source::kInsOnly;
  looks_with_answer_ = has_answer ? looks_with_answer_ + 1 : 0;
  looks_with_gnss_ = has_gnss ? looks_with_gnss_ + 1 : 0;
  const bool jumped = jumps_.look(counters_->large_jumps.get());
  const bool surprises = surprising_jumps_.look(counters_->surprising_jumps.get());
  if ((jumped && looks_with_gnss_ > kSettledLooks) ||
      (surprises && looks_with_answer_ > kSettledLooks))
    found_.add(HealthReason::kSolutionJumped);
}

// The first new epoch may be on its way.
bool EstimatorMonitor::waits_for_epoch() const {
  return starts_ > 0 && counters_->accepted_epochs.get() <= epochs_at_start_ + 1;
}

bool EstimatorMonitor::heard_no_epoch() const {
  return starts_ > 0 &&
         counters_->received[index_of(Channel::kGnssEpoch)].get() <= received_at_start_;
}

}  // namespace leonav
