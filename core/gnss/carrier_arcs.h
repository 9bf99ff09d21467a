// Follows the carrier of every satellite from epoch to epoch and decides where an arc, over which
// the ambiguity is one constant, ends.
//
//   arcs.process(time, inputs, &epoch);     // what the signals themselves tell
//   ... range_change() over the satellites whose arc goes on ...
//   arcs.settle(results, &epoch) ;          // what the geometry adds, and what it refutes
//
// Without a range change, settle({}, &epoch) ends every arc under suspicion.
#pragma once
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <memory>
#include <span>

#include "core/capacity.h"
#include "core/gnss/carrier_sample.h"
#include "core/gnss/clock_jump.h"
#include "core/gnss/cycle_slip_config.h"
#include "core/gnss/range_change.h"
#include "core/gnss/slip_cause.h"

namespace leonav {

struct CarrierStatus {
  std::uint32_t arc = 0;               // unique in the run, from 1; 0: no carrier here
  bool started = false;                // this is the arc's first epoch
  SlipCauses causes;                   // why the arc before it ended; none at a satellite's first
  SlipCauses suspected;                // after process(): detectors that a range change may refute
  bool half_cycle_unresolved = false;  // the carrier may yet jump by half a cycle
  // Carriers in metres, continuous over the arc: half cycles and clock jumps are repaired.
  double first_m = kNotMeasured;
  double second_m = kNotMeasured;
  bool doppler_tested = false;  // its change was compared with a Doppler's
};

// Statuses stand in the order of the inputs.
struct ArcEpoch {
  ClockJump clock_jump;  // of this epoch; reported once
  boost::container::static_vector<CarrierStatus, kMaxSatellites> satellites;
};

class CarrierArcs {
 public:
  explicit CarrierArcs(const CycleSlipConfig& config);  // allocates, once
  ~CarrierArcs();
  CarrierArcs(CarrierArcs&&) noexcept;
  CarrierArcs& operator=(CarrierArcs&&) noexcept;

  // Epochs in order of time; one that is not later than the last ends all arcs (kGap). At most one
  // input per satellite: later ones are ignored, as are more than kMaxSatellites.
  void process(GpsTime time, std::span<const CarrierInput> inputs, ArcEpoch* epoch);

  // `results` in the order of the inputs (kNotTested where there was no row), or empty: nothing was
  // tested. kSlipped ends the arc here (kRangeChange), unless the geometry-free combination of a
  // pair refutes a slip of that size: then it is the satellite's clock or orbit that moved.
  // kConsistent clears an arc of suspicion; anything else lets the suspicion stand. On one
  // frequency nothing else tells of small slips, so there an arc ends too that may have slipped
  // (kUndecided at an epoch without a clock jump, or kUnclear by what could be a cycle:
  // kRangeChange), and one where neither a Doppler nor the row could have shown a cycle
  // (kUntested).
  void settle(std::span<const RangeRowResult> results, ArcEpoch* epoch);

  // Ends the arc of a satellite of the last epoch, for a reason of the caller's. Its new status;
  // arc 0 if the satellite had no carrier there.
  CarrierStatus end_arc(SatelliteId satellite, SlipCause cause);

  // How long a satellite of `system` may have been away at `time`, no earlier than the last epoch,
  // for its arc to go on.
  double gap_limit_s(System system, GpsTime time) const;

  // Ends every arc without a successor (a restart); ids go on.
  void reset();

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
