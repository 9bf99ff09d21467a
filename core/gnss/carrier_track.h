// What is remembered of one satellite's carriers, and the tests that need no other satellite.
#pragma once
#include <cmath>
#include <cstdint>

#include "core/gnss/carrier_sample.h"
#include "core/gnss/cycle_slip_config.h"
#include "core/gnss/geometry_free.h"
#include "core/gnss/melbourne_wuebbena.h"
#include "core/gnss/slip_cause.h"

namespace leonav {

// Tests that were loud. `hard`: the arc is over. `soft`: other errors look alike (of a code, of a
// Doppler), and a range change within centimetres refutes them.
struct SlipFindings {
  SlipCauses hard, soft;
  // Bound on what a pair's geometry-free combination has left its trend by; infinite if untested.
  double geometry_free_m = HUGE_VAL;
  bool code_outlier = false;  // the codes are not fit to be learnt from
};

class CarrierTrack {
 public:
  bool is_known() const { return known_; }
  bool is_same_pair(const CarrierSample& sample) const;
  // Within `limit_s` of the last sample.
  bool is_continued_by(const CarrierSample& sample, double limit_s) const;
  const CarrierSample& last() const { return last_; }

  // Flags and lock times; geometry-free and Melbourne-Wuebbena for a pair; half cycles, which may
  // set `sample`'s repair_m. The sample must continue the track.
  SlipFindings examine(const CycleSlipConfig& config, CarrierSample* sample) const;

  // Begins an arc with `sample`. What is known of ionosphere and noise is kept for the same pair
  // while there is no gap.
  void start(const CycleSlipConfig& config, const CarrierSample& sample, bool keep);
  void update(const CycleSlipConfig& config, const CarrierSample& sample, bool with_codes);
  // Of the last sample, where update() was told not to.
  void learn_codes(const CycleSlipConfig& config);
  // Begins an arc with the last sample after all.
  void restart(const CycleSlipConfig& config);
  void forget() { known_ = false; }

  std::uint32_t arc = 0;
  System system = System::kGps;

 private:
  struct PairTest;
  PairTest test_pair(const CycleSlipConfig& config, const CarrierSample& sample) const;
  void begin(const CycleSlipConfig& config, const CarrierSample& sample, bool keep,
             double interval_s);
  void judge_pair(const CycleSlipConfig& config, const PairTest& test, const CarrierSample& sample,
                  SlipFindings* findings) const;
  void settle_half_cycle(const CycleSlipConfig& config, const PairTest& pair, CarrierSample* sample,
                         SlipFindings* findings) const;

  bool known_ = false;
  CarrierSample last_;
  double last_interval_s_ = 0.0;  // from the sample before to the last
  GeometryFreeTrend geometry_free_;
  MelbourneWuebbena wide_lane_;
  // As they were before the last sample, for an arc that is ended there later on.
  GeometryFreeTrend geometry_free_before_;
  MelbourneWuebbena wide_lane_before_;
};

}  // namespace leonav
