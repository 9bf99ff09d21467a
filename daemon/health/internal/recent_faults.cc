#include "daemon/health/internal/recent_faults.h"

namespace leonav {

void RecentFaults::look(const EngineCounters& counters) {
  for (std::size_t i = 0; i < refused_.size(); ++i) {
    refused_[i].count.look(counters.refused[i].get());
    refused_[i].fault = static_cast<InputFault>(counters.refused_as[i].get());
  }
  for (std::size_t stream = 0; stream < rejected_.size(); ++stream) {
    for (std::size_t fault = 0; fault < kInputFaultCount; ++fault)
      rejected_[stream][fault].look(counters.rejected_of_stream[stream][fault].get());
  }
}

InputFault RecentFaults::most_frequent(Channel channel) const {
  const Refused& refused = refused_[index_of(channel)];
  std::int64_t most = refused.count.get();
  InputFault fault = most > 0 ? refused.fault : InputFault::kNone;
  for (std::size_t stream = 0; stream < kStreams.size(); ++stream) {
    if (kStreams[stream] != channel) continue;
    for (std::size_t i = 0; i < kInputFaultCount; ++i) {
      const std::int64_t count = rejected_[stream][i].get();
      if (count <= most) continue;
      most = count;
      fault = static_cast<InputFault>(i);
    }
  }
  return fault;
}

}  // namespace leonav
