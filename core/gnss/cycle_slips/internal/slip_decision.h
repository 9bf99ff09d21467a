// This unit decides about one satellite's arc, given the verdict of the geometry on its row.
#pragma once
#include "core/gnss/cycle_slips/internal/arc_detectors.h"
#include "core/gnss/cycle_slips/internal/carrier_sample.h"
#include "core/gnss/cycle_slips/range_change.h"
#include "core/gnss/measurement/cycle_slip_config.h"
#include "core/gnss/signals/slip_cause.h"

namespace leonav {

// Evidence beside the row.
struct ArcEvidence {
  const CarrierSample& sample;
  const SlipFindings& findings;
  SlipCauses suspected;         // detectors that a row may refute
  bool doppler_tested = false;  // a Doppler shows slips above half a metre
  bool clock_jumped = false;    // at this epoch
};

// Decision about one arc.
struct ArcDecision {
  bool cleared = false;  // nothing slipped, whatever was suspected
  SlipCauses causes;     // causes for which the arc ends
};

// Decides by `row`: nullptr if no geometry was computed, kNotTested where it was and had no row for
// this satellite.
ArcDecision decide_arc(const CycleSlipConfig& config, const ArcEvidence& evidence,
                       const RangeChangeRowResult* row);

}  // namespace leonav
