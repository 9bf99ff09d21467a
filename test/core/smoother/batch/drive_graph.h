// The graph of a drive's whole log.
#pragma once
#include <functional>
#include <memory>

#include "core/smoother/batch/log_graph.h"
#include "core/smoother/drive_rig.h"

namespace leonav::synthetic {

using Edit = std::function<void(KeyframeInput*)>;

inline LogGraph graph_of(const DriveOptions& options, int epochs, const Edit& edit = nullptr) {
  Drive drive(options);
  LogGraph graph(drive.lever_b());
  const auto input = std::make_unique<KeyframeInput>();
  for (int i = 0; i < epochs; ++i) {
    *input = drive.step();
    if (edit) edit(input.get());
    graph.add(*input);
  }
  return graph;
}

// Keyframes that no process ties to the one before.
inline int segments(const LogGraph& graph) {
  int count = 0;
  for (int k = 0; k < graph.size(); ++k) count += graph.at(k).process.exists ? 0 : 1;
  return count;
}

}  // namespace leonav::synthetic
