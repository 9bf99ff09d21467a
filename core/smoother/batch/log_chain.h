// LogChain solves the linearized graph of a whole log by a forward and a backward pass over its
// keyframes (Rauch, Tung, Striebel, AIAA J. 3(8), 1965).
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "core/smoother/batch/log_graph.h"

namespace leonav {

// The step to the minimum of the linearized cost.
struct LogCorrections {
  std::vector<Eigen::VectorXd> core;        // by keyframe, in active states
  Eigen::VectorXd pieces;                   // m
  std::vector<Eigen::MatrixXd> covariance;  // of the core states, by keyframe, all of the log known
  // Without what comes later: the estimate of a filter with the same factors.
  std::vector<Eigen::VectorXd> filtered_core;
  std::vector<Eigen::MatrixXd> filtered_covariance;
};

// So many keyframes have the matrices of both passes in memory at a time. With all systems they are
// a quarter of a megabyte each, most of it of ambiguities; of a day they would fill 20 GB.
constexpr int kLogSegment = 1000;

// The state of the chain at a keyframe are its core states and the pieces under way. Information is
// added where measurements are, covariance where the process leads on, so that a noise of zero
// needs no inverse. A log longer than `segment` > 0 keyframes has the forward pass repeated,
// segment by segment, on the way back: the same results to the bit. `progress` gets the share done.
// Returns false if the log has no keyframe or no unique solution.
bool solve_chain(const LogGraph& graph, const std::function<void(double)>& progress,
                 LogCorrections* corrections, int segment = kLogSegment);

}  // namespace leonav
