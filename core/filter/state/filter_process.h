// What the filter's state has gone through since begin(), for estimators that look back.
#pragma once
#include "core/filter/state/ekf_state.h"

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
  // What constraints on the motion since tell of the state then, beyond what is told of the
  // process: 0.5 x_then^T information x_then - gradient^T x_then. Only where `has_information`.
  EkfCovariance information;
  EkfCorrection gradient;
  bool has_information = false;
  // False once something other than a process has happened: the filter has been started, or has got
  // an attitude from outside.
  bool continuous = false;

  void begin(Eigen::Index states) {
    transition.setIdentity(states, states + 1);
    noise.setZero(states, states);
    continuous = true;
    has_information = false;
  }
  // A measurement h x_now = innovation, of the filter's state now, with noise of `variance`: the
  // process is from now on the one that has met it.
  void condition(const EkfCorrection& h, double innovation, double variance);
  // State `row` starts anew, or an additional last one does.
  void start(Eigen::Index row, double variance);
  void append(double variance);
  void remove(Eigen::Index row);
};

// A covariance P after a scalar measurement, in Joseph's form, which stays symmetric and positive:
// `spread` P h, `variance` h P h + R, `gain` one over the other.
void joseph_update(const EkfCorrection& gain, const EkfCorrection& spread, double variance,
                   EkfCovariance* covariance);

}  // namespace leonav
