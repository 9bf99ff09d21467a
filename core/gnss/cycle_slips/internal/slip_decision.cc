#include "core/gnss/cycle_slips/internal/slip_decision.h"

#include <cmath>

namespace leonav {
namespace {

// A pair of slips that leaves the ionosphere-free combination unchanged (60 and 77 cycles of GPS L1
// and L2) moves the geometry-free one by metres: a range change clears a pair only together with
// it.
bool is_cleared(const CycleSlipConfig& config, const ArcEvidence& arc,
                const RangeChangeRowResult& row) {
  return row.verdict == RangeChangeVerdict::kConsistent &&
         (arc.sample.signal_count == 1 ||
          arc.findings.geometry_free_m < config.geometry_free_clear_m);
}

// Returns whether the arc may have slipped, by the geometry and by what refutes it.
bool may_have_slipped(const CycleSlipConfig& config, const ArcEvidence& arc,
                      const RangeChangeRowResult& row) {
  const double deviation_m = std::abs(row.deviation_m);
  switch (row.verdict) {
    case RangeChangeVerdict::kNotTested:
    case RangeChangeVerdict::kConsistent:
      break;
    case RangeChangeVerdict::kSlipped:
      // Slips of whole or half cycles that leave the geometry-free combination alone within 1.5 cm
      // move the ionosphere-free one by 36 cm or more (2 and 1.5 cycles of GPS L1 and L2; other
      // pairs: more).
      return !(arc.findings.geometry_free_m < config.geometry_free_quiet_m &&
               deviation_m < config.range_change_refuted_m);
    case RangeChangeVerdict::kUndecided:
      // For a pair the other detectors decide. Where the clock or the tags have jumped, the
      // carriers may be of another instant than the predicted ranges, and contradict them without a
      // slip.
      return arc.sample.signal_count == 1 && !arc.clock_jumped;
    case RangeChangeVerdict::kUnclear:
      return arc.sample.signal_count == 1 &&
             deviation_m + config.range_change_clear * row.sigma_m >=
                 arc.sample.signal[0].wavelength_m;
  }
  return false;
}

// On one frequency only a range change that would have shown a cycle, or a Doppler, can show that
// nothing slipped.
bool is_tested(const CycleSlipConfig& config, const ArcEvidence& arc,
               const RangeChangeRowResult& row) {
  if (arc.sample.signal_count == 2 || arc.doppler_tested) return true;
  return row.verdict != RangeChangeVerdict::kUndecided && row.sigma_m > 0.0 &&
         config.range_change_limit * row.sigma_m <= arc.sample.signal[0].wavelength_m;
}

}  // namespace

ArcDecision decide_arc(const CycleSlipConfig& config, const ArcEvidence& evidence,
                       const RangeChangeRowResult* row) {
  ArcDecision decision;
  if (row != nullptr && is_cleared(config, evidence, *row)) {
    decision.cleared = true;
    return decision;
  }
  decision.causes = evidence.suspected;
  if (row == nullptr) return decision;
  if (may_have_slipped(config, evidence, *row)) decision.causes |= SlipCause::kRangeChange;
  if (!decision.causes.any() && !is_tested(config, evidence, *row))
    decision.causes = SlipCause::kUntested;
  return decision;
}

}  // namespace leonav
