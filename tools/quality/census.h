// First pass: which satellites and signals a log holds, how often, and at which interval. From it
// follows which carriers are paired, the same from the first epoch to the last.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "core/gnss/gnss_config.h"
#include "core/gnss/observation.h"

namespace leonav {

// Time of the epochs. An epoch not later than one before it is counted and takes no part in
// anything else.
struct EpochTimes {
  std::uint64_t epochs = 0;  // in order
  std::uint64_t backwards = 0;
  GpsTime first, last;
  double interval_s = 0.0;  // the most frequent one, to the millisecond; 0: fewer than two epochs
  std::uint64_t gaps = 0;   // intervals above 1.5 times that
  double missing = 0.0;     // epochs that would fill them
  double longest_gap_s = 0.0;
};

// Carriers of one satellite. The reference is followed with each of the others in turn.
struct CarrierPlan {
  SignalCode reference;
  std::vector<SignalCode> others;  // at most one per band; the best partner first
};

class Census {
 public:
  explicit Census(const GnssConfig& config) : config_(config) {}

  void add(const RawEpoch& epoch);
  EpochTimes times() const;
  // Every satellite with a carrier. The reference: the band most often measured, of those within a
  // tenth of it the one that comes first for the navigator (SignalPreference); likewise the best
  // partner, among those whose combination the navigator takes for useful, if there is one.
  std::map<SatelliteId, CarrierPlan> plans() const;

 private:
  struct SignalCount {
    SignalCode code;
    std::uint64_t carriers = 0;  // with code
  };

  CarrierPlan plan_of(System system, const std::vector<SignalCount>& signals) const;

  GnssConfig config_;
  EpochTimes times_;
  std::map<std::int64_t, std::uint64_t> intervals_;  // ms -> how often
  std::map<SatelliteId, std::vector<SignalCount>> satellites_;
};

}  // namespace leonav
