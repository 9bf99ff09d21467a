#include "core/ekf/filter_process.h"

namespace leonav {

using Eigen::Index;

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
