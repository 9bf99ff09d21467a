#include "tools/smooth/solver_choice.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "tools/common/format.h"

namespace leonav {
namespace {

// Of the graph and Ceres together, measured: 97 MB for 37,000 measurements, 312 MB for 150,000.
constexpr double kBytesPerMeasurement = 2000.0;
constexpr long kMostMeasurements = 3'000'000;
constexpr double kGigabyte = 1e9;

std::optional<double> number_in(const std::filesystem::path& path) {
  std::ifstream file(path);
  double value = 0.0;
  if (file >> value) return value;
  return std::nullopt;
}

// The number behind a word.
std::optional<double> number_of(const std::string& word, const std::filesystem::path& path) {
  std::ifstream file(path);
  std::string key;
  for (double value = 0.0; file >> key >> value;)
    if (key == word) return value;
  return std::nullopt;
}

// The folder of this process's group below the mount of control groups (version 2): what follows
// "0::/" in its line.
std::filesystem::path group_in(const std::string& membership) {
  std::ifstream file(membership);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("0::/")) return line.substr(4);
  return {};
}

}  // namespace

long measurements_of(const LogGraph& graph) {
  long sum = 0;
  for (int k = 0; k < graph.size(); ++k) sum += static_cast<long>(graph.at(k).measurements.size());
  return sum;
}

std::optional<double> left_to_group(const std::string& mount, const std::string& membership) {
  std::optional<double> left;
  const std::filesystem::path root(mount);
  // The limits of all groups above hold as well.
  for (std::filesystem::path group = root / group_in(membership);; group = group.parent_path()) {
    const auto limit = number_in(group / "memory.max");
    const auto used = number_in(group / "memory.current");
    if (limit && used) {
      const double taken = *used - number_of("inactive_file", group / "memory.stat").value_or(0.0);
      left = std::min(left.value_or(*limit), std::max(0.0, *limit - taken));
    }
    if (group == root || !group.has_relative_path()) return left;
  }
}

std::optional<double> available_memory() {
  std::optional<double> available;
  std::ifstream file("/proc/meminfo");
  std::string key, unit;
  for (double kilobytes = 0.0; file >> key >> kilobytes; std::getline(file, unit))
    if (key == "MemAvailable:") available = 1024.0 * kilobytes;
  const auto left = left_to_group("/sys/fs/cgroup", "/proc/self/cgroup");
  if (!left) return available;
  return std::min(available.value_or(*left), *left);
}

SolverChoice choose_solver(long measurements, std::optional<double> available_bytes) {
  const double needed = kBytesPerMeasurement * static_cast<double>(measurements);
  std::string of = format("auto: for %ld measurements ceres needs some %.1f GB", measurements,
                          needed / kGigabyte);
  if (available_bytes) of += format(", and %.1f GB are free", *available_bytes / kGigabyte);
  if (measurements > kMostMeasurements)
    return {"chain", format("%s, but more than %ld measurements take it long", of.c_str(),
                            kMostMeasurements)};
  if (available_bytes && needed > 0.5 * *available_bytes)
    return {"chain", of + ", of which it is to take at most half"};
  return {"ceres", of};
}

}  // namespace leonav
