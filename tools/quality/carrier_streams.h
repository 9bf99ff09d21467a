// Follows the carriers of all satellites, each reference carrier with each of its partners, and
// lists what broke them. A satellite with three bands is followed in two streams; what breaks its
// reference carrier shows in both and is one event.
#pragma once
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "core/gnss/carrier_arcs.h"
#include "tools/quality/census.h"
#include "tools/quality/range_check.h"
#include "tools/quality/sky.h"

namespace leonav {

struct ArcBreak {
  GpsTime time;
  SatelliteId satellite;
  std::vector<SignalCode>
      signals;  // of the carriers whose arcs ended; which of them cannot be told
  SlipCauses causes;
  double elevation = 0.0;  // rad; NaN: not known
};

// More than an interruption: the carrier was there before and after, and its count is not what it
// was. Jumps of the receiver's clock are no satellite's slips, nor is an arc that nothing could
// test.
bool is_slip(SlipCauses causes);

// The receiver says so itself, by its loss-of-lock flag or its lock time.
bool is_told_by_receiver(SlipCauses causes);

// The carriers that level a code: continuous over the arc, half cycles and clock jumps repaired.
struct PairedCarriers {
  std::uint64_t arc = 0;  // unique in the run; 0: no pair here
  double own_m = 0.0;     // of the code's band
  double other_m = 0.0;
  double own_hz = 0.0, other_hz = 0.0;
};

class CarrierStreams {
 public:
  CarrierStreams(std::map<SatelliteId, CarrierPlan> plans, const CycleSlipConfig& config);
  ~CarrierStreams();

  // Returns the arcs that ended at this epoch, in the satellites' order.
  const std::vector<ArcBreak>& process(const RawEpoch& raw, const Sky& sky);

  // At the last epoch. The reference band goes with its best partner, every other one with the
  // reference.
  PairedCarriers carriers_of(SatelliteId satellite, char band) const;
  // A carrier, or pair, was there and was followed.
  bool is_followed(SatelliteId satellite) const;
  bool half_cycle_unresolved(SatelliteId satellite) const;
  std::uint64_t clock_jumps() const { return clock_jumps_; }
  bool has_pair(SatelliteId satellite) const;

 private:
  struct Stream;
  void collect(const RawEpoch& raw, const Sky& sky, std::size_t place);
  const CarrierStatus* status_of(SatelliteId satellite, std::size_t place) const;

  std::map<SatelliteId, CarrierPlan> plans_;
  std::vector<std::unique_ptr<Stream>> streams_;
  std::vector<ArcBreak> breaks_;
  std::uint64_t clock_jumps_ = 0;
};

}  // namespace leonav
