// This unit fits the signals that a receiver measured at one time into a RawEpoch, which holds at
// most kMaxObservations.
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/gnss/measurement/gnss_config.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// What did not fit into the epochs so far.
struct CapacityLosses {
  std::uint64_t spare = 0;   // signals beside another one on the same frequency that did fit
  std::uint64_t usable = 0;  // signals without such another one: the estimator misses them
  std::set<std::pair<System, SignalCode>> spare_codes, usable_codes;  // their names
};

// EpochCapacity keeps of more signals than an epoch holds those that the estimator can use,
// whatever their order. The estimator takes one code of each frequency of a satellite
// (select_signals), so that the first of each frequency come before all seconds, these before all
// thirds. Within such a round the frequencies of each satellite come in the order of the
// preference.
class EpochCapacity {
 public:
  // Sorts `signals` by satellite and code, and makes them the observations of `epoch`; there is at
  // most one per satellite and code. What does not fit is counted in losses().
  void fit(std::vector<SignalObservation>* signals, RawEpoch* epoch);
  const CapacityLosses& losses() const { return losses_; }

 private:
  void keep_usable(std::vector<SignalObservation>* signals);

  // The preferred bands and attributes of each system: who reads a recording or a receiver does not
  // know the navigator's configuration, and takes the default one.
  GnssConfig config_ = default_gnss_config();
  CapacityLosses losses_;
};

// Returns what a report says of the losses: the limit, which signals, and whether the estimator
// misses them. Empty: none.
std::string spare_text(const CapacityLosses& losses);
std::string usable_text(const CapacityLosses& losses);
// Returns both with their counts in a few words.
std::string summary_of(const CapacityLosses& losses);

}  // namespace leonav
