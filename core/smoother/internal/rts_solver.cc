#include "core/smoother/internal/rts_solver.h"

#include <algorithm>
#include <cmath>

#include "core/smoother/internal/definite_inverse.h"

namespace leonav {
namespace {

using Eigen::Index;
using ekf_index::kMaxSize;

using LowerRoot = Eigen::LLT<Eigen::Ref<EkfCovariance>, Eigen::Lower>;
using Indices = boost::container::static_vector<int, static_cast<std::size_t>(kMaxSize)>;
using Border = BoundedMatrix<kMaxSize, static_cast<int>(kMaxArcs)>;
using BorderVector = BoundedVector<static_cast<int>(kMaxArcs)>;
using WalkRows = BoundedMatrix<static_cast<int>(kMaxArcs), kMaxSize>;
using BorderMatrix = BoundedMatrix<static_cast<int>(kMaxArcs), static_cast<int>(kMaxArcs)>;

// Replaces the matrix by its Cholesky root; false if a pivot is not positive.
bool factorize(EkfCovariance* matrix) {
  const LowerRoot root(*matrix);
  return root.info() == Eigen::Success && matrix->diagonal().allFinite();
}

// A larger step is a new start.
constexpr double kLargestWalk = 1.0;  // m^2

// The states of two successive keyframes: those that the process moves, and the ambiguities that it
// carries over.
struct Partition {
  Indices moved_before, moved;  // by the earlier and the later keyframe
  Indices kept_before, kept;    // parallel
  Indices walking;              // those of the later keyframe that walk on the way

  void of(const LinearProcessFactor& process_factor, Index core_before, Index core);
};

// Returns whether the noise of ambiguity `i` is its own and small.
bool walks_alone(const EkfCovariance& noise, Index i) {
  return noise(i, i) < kLargestWalk && noise.col(i).cwiseAbs().sum() == noise(i, i);
}

void Partition::of(const LinearProcessFactor& process_factor, Index core_before, Index core) {
  const EkfCovariance& F = process_factor.F;
  moved_before.clear(), moved.clear(), kept_before.clear(), kept.clear(), walking.clear();
  Indices origin(static_cast<std::size_t>(F.rows()), -1);
  for (Index j = 0; j < F.cols(); ++j) {
    const auto column = static_cast<int>(j);
    if (j < core_before) {
      moved_before.push_back(column);
      continue;
    }
    int leads_to = -1, entries = 0;
    for (Index i = 0; i < F.rows(); ++i) {
      if (F(i, j) == 0.0) continue;
      ++entries;
      leads_to = static_cast<int>(i);
    }
    const bool is_kept = entries == 1 && leads_to >= core && F(leads_to, j) == 1.0 &&
                         walks_alone(process_factor.noise, leads_to);
    if (is_kept)
      origin[static_cast<std::size_t>(leads_to)] = column;
    else
      moved_before.push_back(column);
  }
  for (Index i = 0; i < F.rows(); ++i) {
    const int from = origin[static_cast<std::size_t>(i)];
    if (from < 0) {
      moved.push_back(static_cast<int>(i));
    } else {
      kept.push_back(static_cast<int>(i));
      kept_before.push_back(from);
      if (process_factor.noise(i, i) > 0.0) walking.push_back(static_cast<int>(i));
    }
  }
}

template <typename To, typename From>
void gather(const From& from, const Indices& rows, const Indices& columns, To* to) {
  to->resize(static_cast<Index>(rows.size()), static_cast<Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (std::size_t i = 0; i < rows.size(); ++i)
      (*to)(static_cast<Index>(i), static_cast<Index>(j)) = from(rows[i], columns[j]);
}

template <typename To, typename From>
void gather(const From& from, const Indices& rows, To* to) {
  to->resize(static_cast<Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) (*to)(static_cast<Index>(i)) = from(rows[i]);
}

template <typename From, typename To>
void scatter(const From& from, const Indices& rows, const Indices& columns, To* to) {
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (std::size_t i = 0; i < rows.size(); ++i)
      (*to)(rows[i], columns[j]) = from(static_cast<Index>(i), static_cast<Index>(j));
}

template <typename From, typename To>
void scatter(const From& from, const Indices& rows, To* to) {
  for (std::size_t i = 0; i < rows.size(); ++i) (*to)(rows[i]) = from(static_cast<Index>(i));
}

}  // namespace

// What the backward pass needs of the forward one; names as in the header.
struct RtsSolver::Step {
  Partition partition;
  EkfCovariance root;             // L
  EkfCovariance spread;           // X
  EkfCovariance predicted;        // W
  Border border;                  // Y
  Border predicted_border;        // Z
  EkfCorrection reduced;          // y
  EkfCorrection predicted_error;  // X^T y - offset: the mean of x at b = 0
  EkfCorrection kept_offset;      // by state of the later keyframe; zero where it is moved
  // Of the ambiguities that walk:
  BorderMatrix walk_root;     // T
  WalkRows walk_rows;         // V
  BorderVector walk_reduced;  // T^-1 times the gradient
  BorderVector walk_weight;   // diagonal of Q^-1
};

RtsSolver::RtsSolver(int capacity)
    : steps_(std::make_unique<Step[]>(static_cast<std::size_t>(capacity))),
      measurements_(std::make_unique<MeasurementInformation>()),
      process_factor_(std::make_unique<LinearProcessFactor>()) {}

RtsSolver::~RtsSolver() = default;

// Adds what keyframe `i` itself tells to the information about it.
void RtsSolver::collect(const Window& window, const Eigen::Vector3d& lever_arm_b, int i) {
  if (i == 0) linearize_prior(window, &information_, &gradient_);
  accumulate_information(window.at(i), lever_arm_b, measurements_.get());
  information_ += measurements_->information;
  gradient_ += measurements_->gradient;
  if (i + 1 < window.size())
    add_process_information(window.at(i), window.at(i + 1).process_factor, &information_,
                            &gradient_);
}

// Turns the information about keyframe `i` into that about the next, before its measurements.
bool RtsSolver::move_on(const Window& window, int i, Step* step) {
  const Keyframe& before = window.at(i);
  const Keyframe& keyframe = window.at(i + 1);
  linearize_process_factor(before, keyframe, process_factor_.get());
  const LinearProcessFactor& process = *process_factor_;
  Partition& parts = step->partition;
  parts.of(process, before.active.core_size(), keyframe.active.core_size());

  gather(information_, parts.moved_before, parts.moved_before, &step->root);
  if (!factorize(&step->root)) return false;
  const auto lower = step->root.triangularView<Eigen::Lower>();
  gather(information_, parts.moved_before, parts.kept_before, &step->border);
  lower.solveInPlace(step->border);
  gather(gradient_, parts.moved_before, &step->reduced);
  lower.solveInPlace(step->reduced);
  step->spread.resize(static_cast<Index>(parts.moved_before.size()),
                      static_cast<Index>(parts.moved.size()));
  for (std::size_t j = 0; j < parts.moved.size(); ++j)
    for (std::size_t k = 0; k < parts.moved_before.size(); ++k)
      step->spread(static_cast<Index>(k), static_cast<Index>(j)) =
          process.F(parts.moved[j], parts.moved_before[k]);
  lower.solveInPlace(step->spread);

  EkfCovariance covariance;
  gather(process.noise, parts.moved, parts.moved, &covariance);
  covariance.selfadjointView<Eigen::Lower>().rankUpdate(step->spread.transpose());
  covariance.triangularView<Eigen::StrictlyUpper>() = covariance.transpose();
  if (!invert(covariance, &step->predicted)) return false;
  step->predicted_border.noalias() = step->spread.transpose() * step->border;
  EkfCorrection offset;
  gather(process.offset, parts.moved, &offset);
  step->predicted_error.noalias() = step->spread.transpose() * step->reduced;
  step->predicted_error -= offset;

  BorderMatrix kept;  // S, then A'_bb
  gather(information_, parts.kept_before, parts.kept_before, &kept);
  BorderVector kept_gradient;
  gather(gradient_, parts.kept_before, &kept_gradient);
  kept.selfadjointView<Eigen::Lower>().rankUpdate(step->border.transpose(), -1.0);
  kept_gradient.noalias() -= step->border.transpose() * step->reduced;
  Border coupling;  // A'_xb
  coupling.noalias() = step->predicted * step->predicted_border;
  BorderMatrix added;
  added.noalias() = step->predicted_border.transpose() * coupling;
  kept.triangularView<Eigen::StrictlyUpper>() = kept.transpose();
  kept += added;
  const EkfCorrection moved_gradient = step->predicted * step->predicted_error;
  kept_gradient.noalias() += step->predicted_border.transpose() * moved_gradient;

  const Index size = keyframe.active.size();
  information_.resize(size, size);
  gradient_.resize(size);
  scatter(step->predicted, parts.moved, parts.moved, &information_);
  scatter(kept, parts.kept, parts.kept, &information_);
  scatter(coupling, parts.moved, parts.kept, &information_);
  scatter(coupling.transpose(), parts.kept, parts.moved, &information_);
  scatter(moved_gradient, parts.moved, &gradient_);
  scatter(kept_gradient, parts.kept, &gradient_);
  if (!walk(process.noise, step)) return false;
  // From errors of the earlier keyframe's ambiguities to those of the later one's.
  step->kept_offset.setZero(size);
  for (const int state : parts.kept) step->kept_offset(state) = process.offset(state);
  gradient_.noalias() -= information_ * step->kept_offset;
  return true;
}

// Takes away what the random walk of ambiguities makes uncertain.
bool RtsSolver::walk(const EkfCovariance& noise, Step* step) {
  const Indices& walking = step->partition.walking;
  if (walking.empty()) return true;
  const auto count = static_cast<Index>(walking.size());
  step->walk_root.resize(count, count);
  step->walk_rows.resize(count, information_.cols());
  step->walk_reduced.resize(count);
  step->walk_weight.resize(count);
  for (Index i = 0; i < count; ++i) {
    const int row = walking[static_cast<std::size_t>(i)];
    for (Index j = 0; j < count; ++j)
      step->walk_root(i, j) = information_(row, walking[static_cast<std::size_t>(j)]);
    step->walk_weight(i) = 1.0 / noise(row, row);
    step->walk_root(i, i) += step->walk_weight(i);
    step->walk_rows.row(i) = information_.row(row);
    step->walk_reduced(i) = gradient_(row);
  }
  const Eigen::LLT<Eigen::Ref<BorderMatrix>, Eigen::Lower> root(step->walk_root);
  if (root.info() != Eigen::Success) return false;
  const auto lower = step->walk_root.triangularView<Eigen::Lower>();
  lower.solveInPlace(step->walk_rows);
  lower.solveInPlace(step->walk_reduced);
  information_.selfadjointView<Eigen::Lower>().rankUpdate(step->walk_rows.transpose(), -1.0);
  information_.triangularView<Eigen::StrictlyUpper>() = information_.transpose();
  gradient_.noalias() -= step->walk_rows.transpose() * step->walk_reduced;
  return true;
}

bool RtsSolver::solve_newest() {
  if (!factorize(&information_)) return false;
  information_.triangularView<Eigen::Lower>().solveInPlace(gradient_);
  information_.transpose().triangularView<Eigen::Upper>().solveInPlace(gradient_);
  return gradient_.allFinite();
}

void RtsSolver::solve_backward(int i, WindowCorrections* corrections) const {
  const Step& step = steps_[static_cast<std::size_t>(i)];
  const Partition& parts = step.partition;
  EkfCorrection next = (*corrections)[static_cast<std::size_t>(i) + 1] + step.kept_offset;
  if (!parts.walking.empty()) {
    BorderVector walked;
    gather(next, parts.walking, &walked);
    for (const int walking : parts.walking) next(walking) = 0.0;
    walked = walked.cwiseProduct(step.walk_weight);
    step.walk_root.triangularView<Eigen::Lower>().solveInPlace(walked);
    walked += step.walk_reduced;
    walked.noalias() -= step.walk_rows * next;
    step.walk_root.transpose().triangularView<Eigen::Upper>().solveInPlace(walked);
    scatter(walked, parts.walking, &next);
  }
  BorderVector kept;
  gather(next, parts.kept, &kept);
  EkfCorrection unexplained;  // x' minus its mean given b
  gather(next, parts.moved, &unexplained);
  unexplained -= step.predicted_error;
  unexplained.noalias() += step.predicted_border * kept;
  EkfCorrection moved = step.reduced;
  moved.noalias() -= step.border * kept;
  const EkfCorrection weighed = step.predicted * unexplained;
  moved.noalias() += step.spread * weighed;
  step.root.transpose().triangularView<Eigen::Upper>().solveInPlace(moved);
  EkfCorrection& correction = (*corrections)[static_cast<std::size_t>(i)];
  correction.resize(moved.size() + kept.size());
  scatter(moved, parts.moved_before, &correction);
  scatter(kept, parts.kept_before, &correction);
}

bool RtsSolver::solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
                      WindowCorrections* corrections) {
  size_ = window.size();
  for (int i = 0; i < size_; ++i) {
    collect(window, lever_arm_b, i);
    if (i + 1 < size_ && !move_on(window, i, &steps_[static_cast<std::size_t>(i)])) return false;
  }
  if (!solve_newest()) return false;
  corrections->resize(static_cast<std::size_t>(size_));
  corrections->back() = gradient_;
  for (int i = size_ - 2; i >= 0; --i) {
    solve_backward(i, corrections);
    if (!(*corrections)[static_cast<std::size_t>(i)].allFinite()) return false;
  }
  return true;
}

void RtsSolver::newest_covariance(EkfCovariance* covariance) const {
  const EkfCovariance& root = information_;
  EkfCovariance inverse = EkfCovariance::Identity(root.rows(), root.rows());
  root.triangularView<Eigen::Lower>().solveInPlace(inverse);
  covariance->setZero(root.rows(), root.rows());
  covariance->selfadjointView<Eigen::Lower>().rankUpdate(inverse.transpose());
  covariance->triangularView<Eigen::StrictlyUpper>() = covariance->transpose();
}

bool RtsSolver::marginalize_oldest(const Window& window, const Eigen::Vector3d& lever_arm_b,
                                   WindowPrior* prior) {
  collect(window, lever_arm_b, 0);
  if (!move_on(window, 0, &steps_[0])) return false;
  prior->at = window.at(1).state;
  prior->information = information_;
  prior->gradient = gradient_;
  return prior->information.allFinite() && prior->gradient.allFinite();
}

}  // namespace leonav
