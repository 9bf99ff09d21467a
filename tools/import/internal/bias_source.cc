#include "tools/import/internal/bias_source.h"

#include <algorithm>
#include <string>

#include "core/base/capacity.h"
#include "tools/import/bias_files.h"

namespace leonav {

std::vector<ScheduledBiases> in_messages(
    const std::map<GpsTime, std::vector<SignalBias>>& by_arrival) {
  std::vector<ScheduledBiases> scheduled;
  for (const auto& [arrival, biases] : by_arrival) {
    for (std::size_t i = 0; i < biases.size(); i += kMaxBiases) {
      const auto begin = biases.begin() + static_cast<std::ptrdiff_t>(i);
      const auto count = static_cast<std::ptrdiff_t>(std::min(kMaxBiases, biases.size() - i));
      scheduled.push_back({arrival, {begin, begin + count}});
    }
  }
  return scheduled;
}

std::vector<ScheduledBiases> load_biases(const std::vector<std::string>& paths, GpsTime start,
                                         GpsTime end, ImportReport* report) {
  std::map<GpsTime, std::vector<SignalBias>> by_arrival;
  for (const std::string& path : paths) {
    long outside = 0, not_sane = 0;
    for (SignalBias bias : read_bias_file(path, report)) {
      if (bias.valid_until <= start || (end.is_set() && bias.valid_from > end)) {
        ++outside;
        continue;
      }
      const bool holds = bias.valid_from <= start;
      bias.time = holds ? start : std::max(start, bias.valid_from.plus_seconds(-kBiasLead_s));
      if (is_sane(bias)) {
        by_arrival[bias.time].push_back(bias);
      } else {
        ++not_sane;
      }
    }
    report->skip(path, "bias that does not hold during the recording", outside);
    report->skip(path, "bias that no satellite can have", not_sane);
  }
  return in_messages(by_arrival);
}

}  // namespace leonav
