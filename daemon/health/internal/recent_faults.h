// RecentFaults is by which fault most inputs of a channel were rejected over the last looks.
#pragma once
#include <array>
#include <cstdint>
#include <string_view>

#include "core/navigator/interface/input_fault.h"
#include "daemon/health/internal/recent_growth.h"
#include "daemon/threads/counters.h"

namespace leonav {

class RecentFaults {
 public:
  void look(const EngineCounters& counters);
  // Returns the fault of most messages of the channel; kNone: none was rejected, or it is not known
  // of which channel it was.
  InputFault most_frequent(Channel channel) const;

 private:
  struct Refused {
    RecentGrowth count;
    InputFault fault = InputFault::kNone;  // of the last one
  };

  std::array<Refused, kInputChannels.size()> refused_;
  std::array<std::array<RecentGrowth, kInputFaultCount>, kStreams.size()> rejected_;
};

}  // namespace leonav
