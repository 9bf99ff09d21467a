#include "core/smoother/chain_solver.h"

#include <algorithm>
#include <cmath>

#include "core/smoother/definite_inverse.h"

namespace leonav {
namespace {

using Eigen::Index;
using ekf_index::kSize;

using LowerRoot = Eigen::LLT<Eigen::Ref<EkfCovariance>, Eigen::Lower>;

// In place; false where a pivot is not positive.
bool factorize(EkfCovariance* matrix) {
  const LowerRoot root(*matrix);
  return root.info() == Eigen::Success && matrix->diagonal().allFinite();
}

// What the prior adds: information and the gradient where the estimate is now.
void add_prior(const Window& window, EkfCovariance* information, EkfCorrection* gradient) {
  const WindowPrior& prior = window.prior();
  const Keyframe& oldest = window.at(0);
  const EkfCorrection moved = active_part(oldest.active, difference(oldest.state, prior.at));
  *information += prior.information;
  *gradient += prior.gradient - prior.information * moved;
}

}  // namespace

ChainSolver::ChainSolver(int capacity)
    : blocks_(std::make_unique<Block[]>(static_cast<std::size_t>(capacity))),
      information_(std::make_unique<MeasurementInformation>()) {}

bool ChainSolver::solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
                        WindowCorrections* corrections) {
  size_ = window.size();
  for (int i = 0; i < size_; ++i) {
    Block& own = block(i);
    gather_information(window.at(i), lever_arm_b, information_.get());
    EkfCovariance& sum = information_->information;
    EkfCorrection& gradient = information_->gradient;
    if (i == 0) {
      add_prior(window, &sum, &gradient);
    } else {
      // The one before has been factorized with this link in it.
      const Block& before = block(i - 1);
      const KeyframeLink& link = window.at(i).link;
      own.below = -link.WF;
      before.root.transpose().triangularView<Eigen::Upper>().solveInPlace<Eigen::OnTheRight>(
          own.below);
      sum += link.weight;
      sum.selfadjointView<Eigen::Lower>().rankUpdate(own.below, -1.0);
      gradient.noalias() -= link.weight * link_error(window.at(i - 1), window.at(i));
      gradient.noalias() -= own.below * before.solved;
    }
    if (i + 1 < size_) {
      const KeyframeLink& next = window.at(i + 1).link;
      sum += next.FWF;
      gradient.noalias() += next.WF.transpose() * link_error(window.at(i), window.at(i + 1));
    }
    own.root = sum;
    if (!factorize(&own.root)) return false;
    own.solved = gradient;
    own.root.triangularView<Eigen::Lower>().solveInPlace(own.solved);
  }

  corrections->resize(static_cast<std::size_t>(size_));
  for (int i = size_ - 1; i >= 0; --i) {
    EkfCorrection& correction = (*corrections)[static_cast<std::size_t>(i)];
    correction = block(i).solved;
    if (i + 1 < size_)
      correction.noalias() -=
          block(i + 1).below.transpose() * (*corrections)[static_cast<std::size_t>(i) + 1];
    block(i).root.transpose().triangularView<Eigen::Upper>().solveInPlace(correction);
    if (!correction.allFinite()) return false;
  }
  return true;
}

void ChainSolver::newest_covariance(EkfCovariance* covariance) const {
  const EkfCovariance& root = block(size_ - 1).root;
  EkfCovariance inverse = EkfCovariance::Identity(root.rows(), root.rows());
  root.triangularView<Eigen::Lower>().solveInPlace(inverse);
  covariance->setZero(root.rows(), root.rows());
  covariance->selfadjointView<Eigen::Lower>().rankUpdate(inverse.transpose());
  covariance->triangularView<Eigen::StrictlyUpper>() = covariance->transpose();
}

// By covariance, not by elimination: where a state is known badly but moves little, its noise's
// inverse would drown what is known of it.
bool marginalize_oldest(const Window& window, const Eigen::Vector3d& lever_arm_b,
                        WindowPrior* prior) {
  const Keyframe& oldest = window.at(0);
  const Keyframe& next = window.at(1);
  MeasurementInformation sum;
  gather_information(oldest, lever_arm_b, &sum);
  add_prior(window, &sum.information, &sum.gradient);
  if (!factorize(&sum.information)) return false;
  const auto root = sum.information.triangularView<Eigen::Lower>();
  root.solveInPlace(sum.gradient);
  sum.information.transpose().triangularView<Eigen::Upper>().solveInPlace(
      sum.gradient);  // the oldest's error, by all but the link

  // Covariance (F P F^T + N) and its inverse; W^-1 is N.
  const KeyframeLink& link = next.link;
  EkfCovariance spread = link.F.transpose();
  root.solveInPlace(spread);
  EkfCovariance predicted = link.noise;
  predicted.noalias() += spread.transpose() * spread;
  if (!invert(predicted, &prior->information)) return false;
  prior->at = next.state;
  const EkfCorrection error = link.F * sum.gradient - link_error(oldest, next);
  prior->gradient.noalias() = prior->information * error;
  return prior->gradient.allFinite();
}

}  // namespace leonav
