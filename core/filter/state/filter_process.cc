#include "core/filter/state/filter_process.h"

#include <algorithm>

namespace leonav {

using Eigen::Index;

void joseph_update(const EkfCorrection& gain, const EkfCorrection& spread, double variance,
                   EkfCovariance* covariance) {
  covariance->noalias() -= gain * spread.transpose();
  covariance->noalias() -= spread * gain.transpose();
  covariance->noalias() += (variance * gain) * gain.transpose();
}

// The joint density of x_now and the measurement, given x_then, conditioned on the measurement;
// what is left is the measurement's own density, given x_then.
void FilterProcess::condition(const EkfCorrection& h, double innovation, double variance) {
  const Index then = transition.cols() - 1;
  if (!has_information) {
    const Index core = std::min<Index>(then, ekf_index::kMaxCore);
    information.setZero(core, core);
    gradient.setZero(then);
    has_information = true;
  }
  const EkfCorrection spread = noise * h;
  const double total = h.dot(spread) + variance;
  const EkfCorrection gain = spread / total;
  const double unexplained = innovation - h.dot(transition.col(then));
  const EkfCorrection seen = transition.leftCols(then).transpose() * h;
  transition.leftCols(then).noalias() -= gain * seen.transpose();
  transition.col(then) += unexplained * gain;
  joseph_update(gain, spread, total, &noise);
  const auto of_core = seen.head(information.rows());
  information.noalias() += (of_core / total) * of_core.transpose();
  gradient += (unexplained / total) * seen;
}

void FilterProcess::join(Index from, Index to, double innovation_m, double variance) {
  const Index then = transition.cols() - 1;
  const auto column_of = [&](Index row) {
    for (Index j = 0; j < then; ++j)
      if (transition(row, j) == 1.0) return j;
    return Index(-1);
  };
  const Index column = column_of(to), column_from = column_of(from);
  if (column < 0) {
    transition.row(to) = transition.row(from);
    transition(to, then) += innovation_m;
    noise.row(to) = noise.row(from);
    noise.col(to) = noise.col(from);
    noise(to, to) = noise(from, from) + variance;
  } else if (column_from >= 0 && joins.size() < joins.capacity()) {
    joins.push_back({column_from, column,
                     innovation_m - (transition(to, then) - transition(from, then)),
                     variance + noise(from, from) + noise(to, to)});
  }
}

void FilterProcess::start(Index row, double variance) {
  transition.row(row).setZero();
  noise.row(row).setZero();
  noise.col(row).setZero();
  noise(row, row) = variance;
}

void FilterProcess::append(double variance) {
  const Index states = noise.rows();
  transition.conservativeResize(states + 1, transition.cols());
  noise.conservativeResize(states + 1, states + 1);
  start(states, variance);
}

void FilterProcess::remove(Index row) {
  const Index last = noise.rows() - 1;
  for (Index i = row; i < last; ++i) {
    transition.row(i) = transition.row(i + 1);
    noise.row(i) = noise.row(i + 1);
  }
  for (Index i = row; i < last; ++i) noise.col(i) = noise.col(i + 1);
  transition.conservativeResize(last, transition.cols());
  noise.conservativeResize(last, last);
}

}  // namespace leonav
