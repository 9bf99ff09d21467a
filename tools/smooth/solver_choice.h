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

// Returns the memory that a process can still take on this machine without swapping, bytes: what
// the system calls available, and in a container what is left to its control group where that has
// a limit; nullopt: the system does not tell.
std::optional<double> available_memory();

// Chooses Ceres where it needs at most half of `available_bytes` and would not take hours, the
// chain otherwise. Unknown memory is taken for enough.
SolverChoice choose_solver(long measurements, std::optional<double> available_bytes);

}  // namespace leonav
