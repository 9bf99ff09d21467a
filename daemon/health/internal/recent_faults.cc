#include "daemon/health/internal/recent_faults.h"

#include <algorithm>
#include <cstdint>

namespace leonav {

void RecentFaults::look(const EngineCounters& counters) {
  std::array<std::array<std::int64_t, kInputFaultCount>, kInputChannels.size()> recent{};
  for (std::size_t channel = 0; channel < refused_.size(); ++channel) {
    for (std::size_t fault = 0; fault < kInputFaultCount; ++fault) {
      refused_[channel][fault].look(counters.refused_by[channel][fault].get());
      recent[channel][fault] += refused_[channel][fault].get();
    }
  }
  for (std::size_t stream = 0; stream < rejected_.size(); ++stream) {
    for (std::size_t fault = 0; fault < kInputFaultCount; ++fault) {
      rejected_[stream][fault].look(counters.rejected_of_stream[stream][fault].get());
      recent[index_of(kStreams[stream])][fault] += rejected_[stream][fault].get();
    }
  }
  for (std::size_t channel = 0; channel < told_.size(); ++channel) {
    const auto& counts = recent[channel];
    const auto most = std::max_element(counts.begin(), counts.end());
    const std::int64_t told = counts[static_cast<std::size_t>(told_[channel])];
    if (told > 0 && *most < 2 * told) continue;
    told_[channel] = *most > 0 ? static_cast<InputFault>(most - counts.begin()) : InputFault::kNone;
  }
}

}  // namespace leonav
