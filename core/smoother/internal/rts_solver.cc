#include "core/smoother/internal/rts_solver.h"

#include <algorithm>
#include <cmath>

#include "core/smoother/internal/definite_inverse.h"

namespace leonav {
namespace {

using Eigen::Index;
using ekf_index::kSize;

using LowerRoot = Eigen::LLT<Eigen::Ref<EkfCovariance>, Eigen::Lower>;

// Replaces the matrix by its Cholesky root; false if a pivot is not positive.
bool factorize(EkfCovariance* matrix) {
  const LowerRoot root(*matrix);
  return root.info() == Eigen::Success && matrix->diagonal().allFinite();
}

// Solves A x = b with A = root root^T, in place.
void solve_in_place(const EkfCovariance& root, EkfCorrection* x) {
  root.triangularView<Eigen::Lower>().solveInPlace(*x);
  root.transpose().triangularView<Eigen::Upper>().solveInPlace(*x);
}

// Computes the covariance of the error after the process factor, F A^-1 F^T + N, and its inverse.
bool move(const EkfCovariance& root, const LinearProcessFactor& process_factor,
          EkfCovariance* spread, EkfCovariance* information) {
  *spread = process_factor.F.transpose();
  root.triangularView<Eigen::Lower>().solveInPlace(*spread);
  EkfCovariance covariance = process_factor.noise;
  covariance.selfadjointView<Eigen::Lower>().rankUpdate(spread->transpose());
  covariance.triangularView<Eigen::StrictlyUpper>() = covariance.transpose();
  return invert(covariance, information);
}

}  // namespace

RtsSolver::RtsSolver(int capacity)
    : blocks_(std::make_unique<Block[]>(static_cast<std::size_t>(capacity))),
      information_(std::make_unique<MeasurementInformation>()),
      process_factor_(std::make_unique<LinearProcessFactor>()) {}

// Computes the prediction of `keyframe`, the i-th, from all keyframes before it.
bool RtsSolver::predict(const Keyframe& before, const Keyframe& keyframe, int i) {
  Block& own = block(i);
  linearize_process_factor(before, keyframe, process_factor_.get());
  if (!move(block(i - 1).root, *process_factor_, &own.spread, &own.predicted)) return false;
  own.predicted_error = -process_factor_->offset;
  own.predicted_error.noalias() += process_factor_->F * block(i - 1).filtered;
  return true;
}

bool RtsSolver::solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
                      WindowCorrections* corrections) {
  size_ = window.size();
  for (int i = 0; i < size_; ++i) {
    Block& own = block(i);
    if (i == 0) {
      linearize_prior(window, &own.root, &own.filtered);
    } else {
      if (!predict(window.at(i - 1), window.at(i), i)) return false;
      own.root = own.predicted;
      own.filtered.noalias() = own.predicted * own.predicted_error;
    }
    accumulate_information(window.at(i), lever_arm_b, information_.get());
    own.root += information_->information;
    own.filtered += information_->gradient;
    if (i + 1 < size_)
      add_process_information(window.at(i), window.at(i + 1).process_factor, &own.root,
                              &own.filtered);
    if (!factorize(&own.root)) return false;
    solve_in_place(own.root, &own.filtered);
  }

  corrections->resize(static_cast<std::size_t>(size_));
  for (int i = size_ - 1; i >= 0; --i) {
    EkfCorrection& correction = (*corrections)[static_cast<std::size_t>(i)];
    correction = block(i).filtered;
    if (i + 1 < size_) {
      const Block& next = block(i + 1);
      const EkfCorrection more =
          (*corrections)[static_cast<std::size_t>(i) + 1] - next.predicted_error;
      EkfCorrection added = next.spread * (next.predicted * more);
      block(i).root.transpose().triangularView<Eigen::Upper>().solveInPlace(added);
      correction += added;
    }
    if (!correction.allFinite()) return false;
  }
  return true;
}

void RtsSolver::newest_covariance(EkfCovariance* covariance) const {
  const EkfCovariance& root = block(size_ - 1).root;
  EkfCovariance inverse = EkfCovariance::Identity(root.rows(), root.rows());
  root.triangularView<Eigen::Lower>().solveInPlace(inverse);
  covariance->setZero(root.rows(), root.rows());
  covariance->selfadjointView<Eigen::Lower>().rankUpdate(inverse.transpose());
  covariance->triangularView<Eigen::StrictlyUpper>() = covariance->transpose();
}

bool marginalize_oldest(const Window& window, const Eigen::Vector3d& lever_arm_b,
                        WindowPrior* prior) {
  const Keyframe& oldest = window.at(0);
  const Keyframe& next = window.at(1);
  MeasurementInformation sum;
  EkfCovariance root;
  EkfCorrection error;  // of the oldest keyframe, from everything except the process factor
  linearize_prior(window, &root, &error);
  accumulate_information(oldest, lever_arm_b, &sum);
  root += sum.information;
  error += sum.gradient;
  add_process_information(oldest, next.process_factor, &root, &error);
  if (!factorize(&root)) return false;
  solve_in_place(root, &error);
  LinearProcessFactor process_factor;
  linearize_process_factor(oldest, next, &process_factor);
  EkfCovariance spread;
  if (!move(root, process_factor, &spread, &prior->information)) return false;
  prior->at = next.state;
  const EkfCorrection moved = process_factor.F * error - process_factor.offset;
  prior->gradient.noalias() = prior->information * moved;
  return prior->gradient.allFinite();
}

}  // namespace leonav
