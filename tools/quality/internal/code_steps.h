// CodeSteps removes steps of all codes against the carriers.
//
// In some receivers the clock that times the codes steps (by 100 ns in some phones, every ten
// seconds or so), while that of the carriers does not. Such a step is neither multipath nor a slip.
// Steps of whole milliseconds belong to the slip detectors; smaller ones are removed here.
#pragma once
#include <cstdint>
#include <map>
#include <utility>

#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// CodeSteps sums up the steps since the start.
class CodeSteps {
 public:
  explicit CodeSteps(const BandPlan& bands) : bands_(bands) {}

  // Removes the steps so far, including this epoch's, from its codes.
  //
  // A step is the result of find_common_step() (as in the filter) for the signals' changes of code
  // minus carrier since the previous epoch, if it is less than 1000 m.
  void repair(RawEpoch* epoch);
  // Returns the number of steps so far.
  std::uint64_t count() const { return count_; }

 private:
  struct Before {
    std::uint64_t epoch = 0;
    double code_minus_carrier_m = 0.0;
  };

  BandPlan bands_;
  std::map<std::pair<SatelliteId, SignalCode>, Before> before_;
  std::uint64_t epoch_ = 0, count_ = 0;
  double offset_m_ = 0.0;  // of the codes since the start
};

}  // namespace leonav
