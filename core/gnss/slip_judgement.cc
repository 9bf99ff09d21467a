#include "core/gnss/slip_judgement.h"

#include <cmath>

namespace leonav {
namespace {

// A pair of slips that leaves the ionosphere-free combination alone (60 and 77 cycles of GPS L1 and
// L2) moves the geometry-free one by metres: a range change clears a pair only together with it.
bool is_cleared(const CycleSlipConfig& config, const ArcEvidence& arc, const RangeRowResult& row) {
  return row.verdict == RangeVerdict::kConsistent &&
         (arc.sample.sides == 1 || arc.findings.geometry_free_m < config.geometry_free_clear_m);
}

// As far as the geometry tells, and what refutes it.
bool may_have_slipped(const CycleSlipConfig& config, const ArcEvidence& arc,
                      const RangeRowResult& row) {
  const double deviation_m = std::abs(row.deviation_m);
  switch (row.verdict) {
    case RangeVerdict::kNotTested:
    case RangeVerdict::kConsistent:
      break;
    case RangeVerdict::kSlipped:
      // Slips of whole or half cycles that leave the geometry-free combination alone within 1.5 cm
      // move the ionosphere-free one by 36 cm or more (2 and 1.5 cycles of GPS L1 and L2; other
      // pairs: more).
      return !(arc.findings.geometry_free_m < config.geometry_free_quiet_m &&
               deviation_m < config.range_change_refuted_m);
    case RangeVerdict::kUndecided:
      // Of a pair the other detectors tell. Where the clock or the tags have jumped, the carriers
      // may be of another instant than the predicted ranges, and contradict them without a slip.
      return arc.sample.sides == 1 && !arc.clock_jumped;
    case RangeVerdict::kUnclear:
      return arc.sample.sides == 1 && deviation_m + config.range_change_clear * row.sigma_m >=
                                          arc.sample.side[0].wavelength_m;
  }
  return false;
}

// On one frequency only a range change that would have shown a cycle, or a Doppler, tells that
// nothing slipped.
bool is_tested(const CycleSlipConfig& config, const ArcEvidence& arc, const RangeRowResult& row) {
  if (arc.sample.sides == 2 || arc.doppler_tested) return true;
  return row.verdict != RangeVerdict::kUndecided && row.sigma_m > 0.0 &&
         config.range_change_limit * row.sigma_m <= arc.sample.side[0].wavelength_m;
}

}  // namespace

ArcJudgement judge_arc(const CycleSlipConfig& config, const ArcEvidence& evidence,
                       const RangeRowResult* row) {
  ArcJudgement judgement;
  if (row != nullptr && is_cleared(config, evidence, *row)) {
    judgement.cleared = true;
    return judgement;
  }
  judgement.causes = evidence.suspected;
  if (row == nullptr) return judgement;
  if (may_have_slipped(config, evidence, *row)) judgement.causes |= SlipCause::kRangeChange;
  if (!judgement.causes.any() && !is_tested(config, evidence, *row))
    judgement.causes = SlipCause::kUntested;
  return judgement;
}

}  // namespace leonav
