// This unit writes the smoother's window as a LogGraph, so that Ceres has one set of costs.
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "core/smoother/batch/log_graph.h"
#include "core/smoother/window.h"

namespace leonav {

struct WindowGraph {
  LogGraph graph;  // the pieces of keyframe k are its ambiguities in order; they need not ascend
  // By keyframe and ambiguity: what the graph takes its value for, m.
  std::vector<std::vector<double>> ambiguities_m;
};

// Returns the graph with the window's factors at its estimates; nullopt where noise is common to
// ambiguities and other states (a step of the codes against the carriers), which a graph has no
// term for. An ambiguity that the process carries over unchanged is one piece.
std::optional<WindowGraph> graph_of(const Window& window, const Eigen::Vector3d& lever_arm_b);

}  // namespace leonav
