// What both of the bench's modes read off: shares of sorted values, the kernel's word on memory.
#pragma once
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace leonav {

inline double at_share(const std::vector<double>& sorted, double share) {
  return sorted[static_cast<std::size_t>(share * static_cast<double>(sorted.size() - 1))];
}

// `what`: "VmRSS:" resident, "VmHWM:" the most that ever was; 0: not known.
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
