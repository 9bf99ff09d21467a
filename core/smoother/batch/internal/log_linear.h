// This unit linearizes the factors of a LogGraph at the present estimates, to first order in their
// errors.
#pragma once
#include <Eigen/Core>

#include "core/smoother/batch/log_graph.h"
#include "core/smoother/linearization.h"

namespace leonav {

// Information and gradient about the errors of a keyframe: core states, then its pieces in order.
struct LogInformation {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd gradient;
};

// error_k = F error_(k-1) - offset + w, w ~ N(0, noise), in core states.
struct LogLinearProcess {
  Eigen::MatrixXd F, noise;
  Eigen::VectorXd offset;
};

// Linearizes the process factor that leads to keyframe `k` > 0.
LogLinearProcess linearize_process(const LogGraph& graph, int k);

// Adds the information of a keyframe's measurements and of its own prior.
void add_information(const LogGraph& graph, int k, LogInformation* sum);
// Adds what motion constraints and joined arcs between a keyframe and the next say of it; false:
// there were none.
bool add_constraints(const LogGraph& graph, int k, LogInformation* sum);

// Returns a measurement's residual (measured minus predicted, without its ambiguity) and its row at
// the keyframe's estimate.
LinearMeasurement linearize(const LogGraph& graph, const LogKeyframe& keyframe,
                            const LogMeasurement& measurement, const AntennaMotion& antenna);

}  // namespace leonav
