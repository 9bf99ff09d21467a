// What the geometry's verdict on one row means for that satellite's arc.
#pragma once
#include "core/gnss/carrier_sample.h"
#include "core/gnss/carrier_track.h"
#include "core/gnss/cycle_slip_config.h"
#include "core/gnss/range_change.h"
#include "core/gnss/slip_cause.h"

namespace leonav {

// What is known besides.
struct ArcEvidence {
  const CarrierSample& sample;
  const SlipFindings& findings;
  SlipCauses suspected;         // detectors that a row may refute
  bool doppler_tested = false;  // which tells slips above half a metre
  bool clock_jumped = false;    // at this epoch
};

struct ArcJudgement {
  bool cleared = false;  // nothing slipped, whatever was suspected
  SlipCauses causes;     // to end the arc for
};

// `row`: nullptr if no geometry was looked at, kNotTested where it was and had no row for this one.
ArcJudgement judge_arc(const CycleSlipConfig& config, const ArcEvidence& evidence,
                       const RangeRowResult* row);

}  // namespace leonav
