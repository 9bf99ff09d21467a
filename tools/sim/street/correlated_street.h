// CorrelatedStreet is the family of street errors that are random processes in time, without any
// geometry of houses.
#pragma once
#include <cstdint>

#include "tools/sim/street/correlated_multipath.h"
#include "tools/sim/street/on_off.h"
#include "tools/sim/street/street_errors.h"
#include "tools/sim/street/street_slips.h"

namespace leonav::sim {

// Multipath and slips concern every satellite. Below the limit of elevation a signal may also be
// blocked, or arrive by a reflection alone: later by a path that is drawn per episode, and weaker.
class CorrelatedStreet : public StreetErrors {
 public:
  CorrelatedStreet(const StreetErrorsConfig& config, std::uint64_t seed, std::size_t satellite);

  StreetEffect at(const SatelliteSight& sight) override;

 private:
  void reflect(double t, StreetEffect* effect) const;

  StreetErrorsConfig config_;
  std::uint64_t seed_;
  std::size_t satellite_;
  CorrelatedMultipath multipath_;
  OnOff reflected_, blocked_;
  StreetSlips slips_;
};

}  // namespace leonav::sim
