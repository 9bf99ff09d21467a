// What the filter's state has gone through since begin(), for estimators that look back.
#pragma once
#include "core/ekf/ekf_state.h"

namespace leonav {

using ProcessMatrix = BoundedMatrix<ekf_index::kMaxSize, ekf_index::kMaxSize + 1>;

// Linear in the error states: x_now = F x_then + w, w of covariance N. Before the filter's next
// update its covariance is F P_then F^T + N. A state that has started since has a row of zeros in F
// and its start's variance in N; one that has gone has no row.
struct FilterProcess {
  // F (rows: states now, columns: states then) and, as one more column, by how much the filter's
  // updates since have moved its state away from where the process alone would have taken it, with
  // the sign of what undoes it.
  ProcessMatrix transition;
  EkfCovariance noise;
  // False once something other than a process has happened: the filter has been started, or has got
  // an attitude from outside.
  bool continuous = false;

  void begin(Eigen::Index states) {
    transition.setIdentity(states, states + 1);
    noise.setZero(states, states);
    continuous = true;
  }
  // State `row` starts anew, or an additional last one does.
  void start(Eigen::Index row, double variance);
  void append(double variance);
  void remove(Eigen::Index row);
};

}  // namespace leonav
