// This unit chooses the solver of a whole log by the memory that it needs.
#pragma once
#include <optional>
#include <string>

#include "core/smoother/batch/log_graph.h"

namespace leonav {

struct SolverChoice {
  std::string name;    // "ceres", "chain", or "auto" where it is still to be chosen
  std::string reason;  // for the summary
};

// Returns how many measurements the graph's keyframes have together.
long measurements_of(const LogGraph& graph);

// Returns the smallest of what is left of the limits of a process's control group (version 2) and
// of those above it, bytes; nullopt: none has one. Files that the system keeps in memory and can
// drop (inactive_file of memory.stat) count as left. `membership` is the process's file of /proc,
// `mount` the folder of all groups.
std::optional<double> left_to_group(const std::string& mount, const std::string& membership);

// Returns the memory that this process can still take on this machine without swapping, bytes: what
// the system calls available, and at most what is left to its control group; nullopt: the system
// does not tell.
std::optional<double> available_memory();

// Chooses Ceres where it needs at most half of `available_bytes` and would not take hours, the
// chain otherwise. Unknown memory is taken for enough.
SolverChoice choose_solver(long measurements, std::optional<double> available_bytes);

}  // namespace leonav
