#include "tools/import/internal/delay_source.h"

#include <algorithm>
#include <map>
#include <utility>

namespace leonav {

std::vector<ScheduledBiases> schedule_delays(std::vector<SignalBias> delays, GpsTime start,
                                             GpsTime end) {
  std::stable_sort(delays.begin(), delays.end(),
                   [](const SignalBias& a, const SignalBias& b) { return a.time < b.time; });
  std::map<std::pair<SatelliteId, SignalCode>, SignalBias> at_start;
  std::vector<SignalBias> arriving;
  for (const SignalBias& delay : delays) {
    const auto signal = std::pair(delay.satellite, delay.code);
    const double since_start_s = seconds_between(delay.time, start);
    if (!is_sane(delay) || since_start_s < -kLongestBiasAge_s) continue;
    if (since_start_s <= 0.0) {
      at_start[signal] = delay;
    } else if (since_start_s > kLongestBiasAge_s || !at_start.try_emplace(signal, delay).second) {
      arriving.push_back(delay);
    }
  }
  std::map<GpsTime, std::vector<SignalBias>> by_arrival;
  for (auto& [signal, delay] : at_start) {
    delay.time = start;
    by_arrival[start].push_back(delay);
  }
  for (const SignalBias& delay : arriving) {
    if (!end.is_set() || delay.time <= end) by_arrival[delay.time].push_back(delay);
  }
  return in_messages(by_arrival);
}

}  // namespace leonav
