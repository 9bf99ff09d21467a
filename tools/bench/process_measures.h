// This unit holds measures that both modes of the bench use: quantiles, and the process's memory.
#pragma once
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace leonav {

// Returns the quantile `share` (0 to 1) of sorted values: of the two between which it falls, the
// lower one. Precondition: `sorted` is not empty.
inline double quantile_below(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

// Returns the process's memory in MB as the kernel reports it, 0 if unknown. `what` is "VmRSS:" for
// resident memory or "VmHWM:" for its maximum.
inline double memory_mb(std::string_view what) {
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word) {
    double kilobytes = 0.0;
    if (word == what && status >> kilobytes) return kilobytes / 1024.0;
  }
  return 0.0;
}

}  // namespace leonav
