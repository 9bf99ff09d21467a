// CarrierStreams tracks the carriers of all satellites, each reference carrier with each of its
// partners, and lists the breaks.
//
// A satellite with three bands is tracked in two streams; a break of its reference carrier shows in
// both and counts as one event.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "core/gnss/cycle_slips/carrier_arcs.h"
#include "tools/quality/internal/census.h"
#include "tools/quality/internal/range_test.h"
#include "tools/quality/internal/sky.h"

namespace leonav {

// The end of one or several carrier arcs of a satellite.
struct ArcBreak {
  GpsTime time;
  SatelliteId satellite;
  // Carriers whose arcs ended; the test cannot distinguish between them.
  std::vector<SignalCode> signals;
  SlipCauses causes;
  double elevation = 0.0;  // rad; NaN: not known
};

// Returns whether the break is a slip: the carrier was there before and after, with another count
// of cycles. Jumps of the receiver's clock are not slips of a satellite, nor are arcs that nothing
// could test.
bool is_slip(SlipCauses causes);

// Returns whether the receiver flags the break, by its loss-of-lock flag or its lock time.
bool is_flagged_by_receiver(SlipCauses causes);

// The carriers that level a code: continuous over the arc, with half cycles and clock jumps
// repaired.
struct PairedCarriers {
  std::uint64_t arc = 0;  // unique in the run; 0: no pair
  double own_m = 0.0;     // on the code's band
  double other_m = 0.0;
  double own_hz = 0.0, other_hz = 0.0;
};

// CarrierStreams holds one stream for every partner of a reference carrier.
class CarrierStreams {
 public:
  CarrierStreams(std::map<SatelliteId, CarrierPlan> plans, const GnssConfig& config);
  ~CarrierStreams();

  // Processes an epoch and returns the arcs that ended, in the satellites' order.
  const std::vector<ArcBreak>& process(const RawEpoch& raw, const Sky& sky);

  // Returns the carriers at the last epoch. The reference band goes with its best partner, every
  // other band with the reference.
  PairedCarriers carriers_of(SatelliteId satellite, char band) const;
  // Returns whether a carrier, or pair, was measured and tracked.
  bool is_followed(SatelliteId satellite) const;
  bool half_cycle_unresolved(SatelliteId satellite) const;
  std::uint64_t clock_jumps() const { return clock_jumps_; }
  bool has_pair(SatelliteId satellite) const;

 private:
  struct Stream;
  void collect(const RawEpoch& raw, const Sky& sky, std::size_t place);
  const CarrierStatus* status_of(SatelliteId satellite, std::size_t place) const;

  std::map<SatelliteId, CarrierPlan> plans_;
  BandPlan bands_;
  std::vector<std::unique_ptr<Stream>> streams_;
  std::vector<ArcBreak> breaks_;
  std::uint64_t clock_jumps_ = 0;
};

}  // namespace leonav
