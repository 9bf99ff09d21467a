#include "drivers/rinex/read_counts.h"

#include <algorithm>

namespace leonav {

void ReadCounts::skip(std::string_view reason, long line, long count) {
  for (Skip& known : skipped) {
    if (known.reason == reason) {
      known.count += count;
      return;
    }
  }
  skipped.push_back({std::string(reason), count, line});
}

long ReadCounts::skipped_total() const {
  long total = 0;
  for (const Skip& skip : skipped) total += skip.count;
  return total;
}

long ReadCounts::count_of(std::string_view reason) const {
  for (const Skip& skip : skipped) {
    if (skip.reason == reason) return skip.count;
  }
  return 0;
}

bool ReadCounts::all_skipped_by_design() const {
  return !skipped.empty() && std::all_of(skipped.begin(), skipped.end(), [](const Skip& skip) {
    return skip.reason.ends_with("not used)");
  });
}

}  // namespace leonav
