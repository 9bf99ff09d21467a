// Decision records whether the result of one epoch was committed or missed its deadline.
#pragma once
#include <cstdint>

#include "core/base/gps_time.h"
#include "core/navigator/interface/smoother_report.h"

namespace leonav {

// One decision. Decisions are part of the journal: together with the inputs they determine every
// output.
struct Decision {
  // The result that was decided about. On the wire: append only.
  enum class Subject : std::uint8_t {
    kFilter = 0,
    kSmoother = 1,
    kKeyframe = 2,  // a keyframe for which the ring to the smoother had no room; never committed
  };
  std::uint64_t sequence = 0;  // counts the decisions of one stage, from 1
  std::uint64_t epoch = 0;     // index k
  GpsTime time;                // data time at which it was decided
  Subject subject = Subject::kFilter;
  bool committed = false;
  std::int32_t iterations = 0;  // that the smoother's solve has done
};

// Returns the decision that a delivered result of the smoother implies for its epoch. A replay
// needs it for the last epochs of a run, whose decisions are not in the journal yet.
Decision decision_of(const SmootherReport& report);

}  // namespace leonav
