// This unit keeps the history of one satellite's carriers and runs the slip tests that need no
// other satellite.
#pragma once
#include <cmath>
#include <cstdint>

#include "core/gnss/cycle_slips/internal/carrier_sample.h"
#include "core/gnss/cycle_slips/internal/melbourne_wuebbena.h"
#include "core/gnss/measurement/cycle_slip_config.h"
#include "core/gnss/measurement/geometry_free.h"
#include "core/gnss/signals/slip_cause.h"

namespace leonav {

// Detectors that found a slip. `certain`: the arc has ended. `refutable`: other errors (of a code,
// of a Doppler) look the same, and a range change within centimetres refutes them.
struct SlipFindings {
  SlipCauses certain, refutable;
  // Bound on the deviation of a pair's geometry-free combination from its trend; infinite if
  // untested.
  double geometry_free_m = HUGE_VAL;
  bool code_outlier = false;  // the codes must not enter the statistics
};

// ArcDetectors holds the history of one satellite's arc and tests the next sample against it.
class ArcDetectors {
 public:
  bool is_known() const { return known_; }
  bool is_same_pair(const CarrierSample& sample) const;
  // Returns whether the sample is within `limit_s` of the last one and of the same signals.
  bool is_continued_by(const CarrierSample& sample, double limit_s) const;
  const CarrierSample& last() const { return last_; }
  // Returns the noise of the last sample's geometry-free combination; it must be a pair.
  GeometryFreeNoise geometry_free_noise(const CycleSlipConfig& config) const;

  // Tests flags and lock times; geometry-free and Melbourne-Wuebbena for a pair; half cycles, which
  // may set repair_m of `sample`. The sample must continue the track.
  SlipFindings detect_slips(const CycleSlipConfig& config, CarrierSample* sample) const;

  // Begins an arc with `sample`. With `keep`, the state of ionosphere and noise is kept for the
  // same pair while there is no gap.
  void start(const CycleSlipConfig& config, const CarrierSample& sample, bool keep);
  void update(const CycleSlipConfig& config, const CarrierSample& sample, bool with_codes);
  // Updates the wide lane by the last sample, where update() was called without codes.
  void update_wide_lane(const CycleSlipConfig& config);
  // Begins an arc at the last sample after update() has already taken it.
  void restart(const CycleSlipConfig& config);
  void clear() { known_ = false; }

  std::uint32_t arc = 0;
  System system = System::kGps;

 private:
  struct PairTest;
  PairTest test_pair(const CycleSlipConfig& config, const CarrierSample& sample) const;
  void begin(const CycleSlipConfig& config, const CarrierSample& sample, bool keep,
             double interval_s);
  void evaluate_pair(const CycleSlipConfig& config, const PairTest& test,
                     const CarrierSample& sample, SlipFindings* findings) const;
  void resolve_half_cycle(const CycleSlipConfig& config, const PairTest& pair,
                          CarrierSample* sample, SlipFindings* findings) const;

  bool known_ = false;
  CarrierSample last_;
  double last_interval_s_ = 0.0;  // from the sample before to the last
  GeometryFreeTrend geometry_free_;
  MelbourneWuebbena wide_lane_;
  // The states before the last sample, for an arc that is ended there afterwards.
  GeometryFreeTrend geometry_free_before_;
  MelbourneWuebbena wide_lane_before_;
};

}  // namespace leonav
