#include "daemon/health/internal/estimator_monitor.h"

#include <utility>

#include "core/navigator/interface/solution.h"
#include "daemon/health/internal/counter_sums.h"

namespace leonav {
namespace {

constexpr int kSettledLooks = 30;

}  // namespace

std::span<const Finding> EstimatorMonitor::look() {
  found_.clear();
  look_at_starts();
  look_at_jumps();
  if (widened_.look(counters_->widened_predictions.get()))
    found_.add(HealthReason::kPredictionWidened);
  if (improbable_.look(event_count(*counters_, EventKind::kImprobable)))
    found_.add(HealthReason::kImprobable);
  if (constraints_left_out_.look(event_count(*counters_, EventKind::kConstraintsLeftOut)))
    found_.add(HealthReason::kConstraintsLeftOut);
  return found_.get();
}

void EstimatorMonitor::look_at_starts() {
  const std::int64_t starts = event_count(*counters_, EventKind::kFilterReset);
  if (std::exchange(starts_, starts) == starts) return;
  epochs_at_start_ = counters_->accepted_epochs.get();
  received_at_start_ = counters_->received[index_of(Channel::kGnssEpoch)].get();
  found_.add(HealthReason::kFilterStartedOver);
}

// While it begins, the solution jumps to where it belongs.
void EstimatorMonitor::look_at_jumps() {
  const auto source = static_cast<Source>(counters_->source.get());
  const bool answers = source == Source::kEkf || source == Source::kSmoother;
  answering_looks_ = answers ? answering_looks_ + 1 : 0;
  const bool jumped = jumps_.look(counters_->large_jumps.get());
  if (jumped && answering_looks_ > kSettledLooks) found_.add(HealthReason::kSolutionJumped);
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
