// FilterProcess records how the filter's state has moved since begin(), for the smoother.
#pragma once
#include <boost/container/static_vector.hpp>

#include "core/base/capacity.h"
#include "core/filter/state/ekf_state.h"

namespace leonav {

using ProcessMatrix = BoundedMatrix<ekf_index::kMaxSize, ekf_index::kMaxSize + 1>;

// That two ambiguities of x_then differ by a known length, because their arcs were joined since
// (ArcJoiner): error of `to` minus error of `from` = innovation_m, with the variance given in m^2.
struct ProcessJoin {
  Eigen::Index from = 0, to = 0;  // columns of F
  double innovation_m = 0.0, variance = 0.0;
};

// The process is linear in the error states: x_now = F x_then + w, cov(w) = N. Before the next
// update the filter's covariance is F P_then F^T + N. A state that has started since then has a row
// of zeros in F and its start variance in N; a state that was removed has no row.
struct FilterProcess {
  // F (rows: states now, columns: states then). One more column holds by how much the filter's
  // updates since then have moved the state away from where the process alone would have taken it,
  // with the sign that undoes it.
  ProcessMatrix transition;
  EkfCovariance noise;
  // Information of motion constraints since then about x_then, beyond their effect on F and N:
  // 0.5 x_then^T information x_then - gradient^T x_then. Valid only if `has_information`. They tell
  // nothing of ambiguities: `information` has no rows and columns beyond the first kMaxCore.
  BoundedMatrix<ekf_index::kMaxCore, ekf_index::kMaxCore> information;
  EkfCorrection gradient;
  bool has_information = false;
  boost::container::static_vector<ProcessJoin, kMaxArcs> joins;
  // False once something other than a process has happened: the filter was started, or was given an
  // attitude from outside.
  bool continuous = false;
  // True once an attitude from outside has replaced the filter's, or the vehicle constants got
  // their start variances again. Integrating the IMU's samples then does not give the later state.
  bool replaced = false;

  void begin(Eigen::Index states) {
    transition.setIdentity(states, states + 1);
    noise.setZero(states, states);
    continuous = true;
    replaced = false;
    has_information = false;
    joins.clear();
  }
  // Conditions the process on a measurement h x_now = innovation with noise of `variance`.
  void condition(const EkfCorrection& h, double innovation, double variance);
  // Records that ambiguity `to` minus ambiguity `from` (rows) is the state's difference plus
  // innovation_m. One that has started since then goes on from the other; two of x_then are kept as
  // one of `joins`. The noise between then and now is not conditioned on the join: it counts as
  // part of its variance, so that each ambiguity keeps a row of its own in F and N.
  void join(Eigen::Index from, Eigen::Index to, double innovation_m, double variance);
  // Starts state `row` anew, or appends one.
  void start(Eigen::Index row, double variance);
  void append(double variance);
  void remove(Eigen::Index row);
};

// Updates a covariance P by a scalar measurement in Joseph's form, which stays symmetric and
// positive: spread = P h, variance = h^T P h + R, gain = spread / variance.
void joseph_update(const EkfCorrection& gain, const EkfCorrection& spread, double variance,
                   EkfCovariance* covariance);

}  // namespace leonav
