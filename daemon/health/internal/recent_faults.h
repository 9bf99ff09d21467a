// RecentFaults is by which fault most inputs of a channel were rejected over the last looks.
#pragma once
#include <array>

#include "core/navigator/interface/input_fault.h"
#include "daemon/health/internal/recent_growth.h"
#include "daemon/threads/counters.h"

namespace leonav {

class RecentFaults {
 public:
  void look(const EngineCounters& counters);
  // Returns the fault of most messages of the channel; kNone: none was rejected, or it is not known
  // of which channel it was. Where several faults come in turn it stays the same one until another
  // has twice as many.
  InputFault most_frequent(Channel channel) const { return told_[index_of(channel)]; }

 private:
  using ByFault = std::array<RecentGrowth, kInputFaultCount>;
  std::array<ByFault, kInputChannels.size()> refused_;
  std::array<ByFault, kStreams.size()> rejected_;
  std::array<InputFault, kInputChannels.size()> told_{};
};

}  // namespace leonav
