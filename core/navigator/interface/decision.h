// A Decision records whether the result of one epoch was committed or missed its deadline.
#pragma once
#include <cstdint>

#include "core/base/gps_time.h"
#include "core/navigator/interface/smoother_report.h"

namespace leonav {

// It is part of the journal: with the inputs, the decisions determine every output.
struct Decision {
  // Which result was decided about. On the wire: append only.
  enum class Subject : std::uint8_t {
    kFilter = 0,
    kSmoother = 1,
    kKeyframe = 2,  // never committed: the ring to the smoother had no room for it
  };
  std::uint64_t sequence = 0;
  std::uint64_t epoch = 0;
  GpsTime time;  // IMU data time at which it was decided
  Subject subject = Subject::kFilter;
  bool committed = false;
  std::int32_t iterations = 0;
};

// The decision that an answer of the smoother implies for its epoch. For the last epochs of a run
// none is recorded yet.
Decision decision_of(const SmootherReport& report);

}  // namespace leonav
