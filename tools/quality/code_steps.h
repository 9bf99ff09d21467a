// Steps of the codes against the carriers that all satellites share: the clock that a receiver's
// codes are measured by moves in steps (100 ns in some phones, every ten seconds or so), that of
// its carriers does not. It is no multipath and no slip, and whole milliseconds are the slip
// detectors' business; what lies between is taken out here.
#pragma once
#include <cstdint>
#include <map>
#include <utility>

#include "core/gnss/observation.h"

namespace leonav {

class CodeSteps {
 public:
  // Takes the steps so far, this epoch's included, out of its codes. A step: what
  // find_common_step(), as in the filter, finds in the signals' changes of code minus carrier since
  // the epoch before, if it is less than 1000 m.
  void repair(RawEpoch* epoch);
  std::uint64_t count() const { return count_; }

 private:
  struct Before {
    std::uint64_t epoch = 0;
    double code_minus_carrier_m = 0.0;
  };

  std::map<std::pair<SatelliteId, SignalCode>, Before> before_;
  std::uint64_t epoch_ = 0, count_ = 0;
  double offset_m_ = 0.0;  // of the codes since the start
};

}  // namespace leonav
