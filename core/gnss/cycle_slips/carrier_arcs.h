// This unit follows the carrier of every satellite from epoch to epoch and ends an arc where its
// ambiguity may have changed. Over one arc the ambiguity is one constant.
//
//   arcs.process(time, inputs, &epoch);            // tests within the signals of a satellite
//   ... range_change() over the satellites whose arc goes on ...
//   arcs.apply_range_change(results, &epoch);      // slips and refutations by the geometry
//
// Without a range change, apply_range_change({}, &epoch) ends every arc under suspicion.
#pragma once
#include <array>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <memory>
#include <span>

#include "core/base/capacity.h"
#include "core/gnss/cycle_slips/internal/carrier_sample.h"
#include "core/gnss/cycle_slips/internal/clock_jump.h"
#include "core/gnss/cycle_slips/range_change.h"
#include "core/gnss/measurement/cycle_slip_config.h"
#include "core/gnss/measurement/geometry_free.h"
#include "core/gnss/signals/slip_cause.h"

namespace leonav {

// The arc of one satellite's carrier at one epoch.
struct CarrierStatus {
  std::uint32_t arc = 0;  // unique in the run, from 1; 0: no carrier here
  bool started = false;   // this is the arc's first epoch
  SlipCauses causes;      // why the previous arc ended; none at a satellite's first arc
  SlipCauses suspected;   // after process(): detectors that a range change may refute
  bool half_cycle_unresolved = false;  // the carrier may still jump by half a cycle
  // Carriers in metres, continuous over the arc: half cycles and clock jumps are repaired.
  double first_m = kNotMeasured;
  double second_m = kNotMeasured;
  // Half cycles that these contain because they were repaired in this arc.
  std::array<double, 2> repaired_m{};
  GeometryFreeNoise geometry_free_noise;  // of a pair
  bool doppler_tested = false;  // the carrier's change was compared with that of a Doppler
};

// The statuses of one epoch, in the order of the inputs.
struct ArcEpoch {
  ClockJump clock_jump;  // clock jump of this epoch, reported once
  boost::container::static_vector<CarrierStatus, kMaxSatellites> satellites;
};

// CarrierArcs runs the detectors of every satellite and numbers the arcs.
class CarrierArcs {
 public:
  // Allocates once. `bands`: the carriers of the LEO satellites.
  explicit CarrierArcs(const CycleSlipConfig& config, const BandPlan& bands = {});
  ~CarrierArcs();
  CarrierArcs(CarrierArcs&&) noexcept;
  CarrierArcs& operator=(CarrierArcs&&) noexcept;

  // Takes the carriers of one epoch, and epochs in order of time; one that is not later than the
  // last ends all arcs (kGap). There is at most one input per satellite: later ones are ignored, as
  // are more than kMaxSatellites.
  void process(GpsTime time, std::span<const CarrierInput> inputs, ArcEpoch* epoch);

  // Applies the verdicts of a range change. `results` are in the order of the inputs (kNotTested
  // where there was no row), or empty where nothing was tested.
  //
  // kSlipped ends the arc here (kRangeChange), unless the geometry-free combination of a pair
  // refutes a slip of that size: then the satellite's clock or orbit has moved. kConsistent clears
  // an arc of suspicion; any other verdict leaves the suspicion, which ends the arc. On one
  // frequency nothing else shows small slips, so an arc ends there too if it may have slipped
  // (kUndecided at an epoch without a clock jump, or kUnclear by what could be a cycle:
  // kRangeChange), or if neither a Doppler nor the row could have shown a cycle (kUntested).
  void apply_range_change(std::span<const RangeChangeRowResult> results, ArcEpoch* epoch);

  // Ends the arc of a satellite of the last epoch for a cause of the caller's. Returns the new
  // status, whose arc is 0 if the satellite had no carrier there.
  CarrierStatus end_arc(SatelliteId satellite, SlipCause cause);

  // Returns how long (s) a satellite of `system` may have been absent at `time` for its arc to
  // continue; `time` must not be earlier than the last epoch.
  double gap_limit_s(System system, GpsTime time) const;

  // Ends every arc without a successor (a restart); identities continue to count.
  void reset();

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
