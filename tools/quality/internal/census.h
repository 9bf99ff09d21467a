// Census counts in a first pass which satellites and signals a log holds, how often, and at which
// interval. The pairs of carriers follow from it, the same from the first epoch to the last.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/gnss/measurement/gnss_config.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// Times of the epochs. An epoch not later than one before it is counted in `backwards` only.
struct EpochTimes {
  std::uint64_t epochs = 0;  // in order
  std::uint64_t backwards = 0;
  GpsTime first, last;
  double interval_s = 0.0;  // the most frequent one, to the millisecond; 0: fewer than two epochs
  std::uint64_t gaps = 0;   // intervals above 1.5 times interval_s
  double missing = 0.0;     // epochs that would fill them
  double longest_gap_s = 0.0;
};

// The carriers of one satellite. The reference is tracked with each of the others.
struct CarrierPlan {
  SignalCode reference;
  std::vector<SignalCode> others;  // at most one per band; the best partner first
};

// Census counts the carriers of every satellite.
class Census {
 public:
  explicit Census(const GnssConfig& config) : config_(config) {}

  void add(const RawEpoch& epoch);
  EpochTimes times() const;
  // Returns the plan of every satellite with a carrier.
  //
  // The reference is on the band most often measured; among those within a tenth of that count the
  // navigator's preference decides (SignalPreference). The best partner is chosen by the same rule,
  // among those whose combination the navigator uses, if there is one.
  std::map<SatelliteId, CarrierPlan> plans() const;

 private:
  struct SignalCount {
    SignalCode code;
    std::uint64_t carriers = 0;  // with a code
  };

  CarrierPlan plan_of(System system, const std::vector<SignalCount>& signals) const;

  GnssConfig config_;
  EpochTimes times_;
  std::map<std::int64_t, std::uint64_t> intervals_;  // ms -> how often
  std::map<SatelliteId, std::vector<SignalCount>> satellites_;
};

}  // namespace leonav
