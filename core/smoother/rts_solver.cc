#include "core/smoother/rts_solver.h"

#include <algorithm>
#include <array>
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

// A matrix of a step in the step's storage, with the properties of `Matrix` in Eigen's eyes.
template <typename Matrix>
using View = Eigen::Map<Matrix, Eigen::internal::traits<Matrix>::Alignment>;

// Replaces the matrix by its Cholesky root; false if a pivot is not positive.
template <typename Matrix>
bool factorize(Matrix* matrix) {
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
                         (F.row(leads_to).array() != 0.0).count() == 1 &&
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

template <typename From, typename To>
void scatter(const From& from, const Indices& rows, const Indices& columns, To* to) {
  for (std::size_t j = 0; j < columns.size(); ++j)
    for (std::size_t i = 0; i < rows.size(); ++i)
      (*to)(rows[i], columns[j]) = from(static_cast<Index>(i), static_cast<Index>(j));
}

// One column of the right side for each pose state of the oldest keyframe.
using Columns = BoundedMatrix<kMaxSize, kPoseStates>;

// Selects or places rows.
template <typename Rhs>
void gather_rows(const Rhs& from, const Indices& rows, Rhs* to) {
  to->resize(static_cast<Index>(rows.size()), from.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) to->row(static_cast<Index>(i)) = from.row(rows[i]);
}
template <typename Rhs>
void scatter_rows(const Rhs& from, const Indices& rows, Rhs* to) {
  for (std::size_t i = 0; i < rows.size(); ++i) to->row(rows[i]) = from.row(static_cast<Index>(i));
}

}  // namespace

// A right side on its way forward, as the backward pass needs it.
template <typename Rhs>
struct RtsSolver::Reduced {
  Rhs moved;      // y = L^-1 g_x
  Rhs predicted;  // X^T y, of a gradient minus the offset: the mean of x at b = 0
  Rhs walking;    // T^-1 of the part of the ambiguities that walk
};

// What the backward pass needs of the forward one; names as in the header.
//
// The matrices lie end to end in one storage, because not all can be large at once. With m and m'
// moved states, k kept and w <= k walking ones, m + k and m' + k at most n, they have
//   m^2 + m m' + m'^2 + (m + m') k + w^2 + w (m' + k) <= 3 n^2 - 3 n k + 2 k^2 <= 3 n^2
// elements.
struct RtsSolver::Step {
  Partition partition;
  BorderVector walk_weight;  // diagonal of Q^-1
  // The offset of the process, by state of the later keyframe.
  EkfCorrection offset;
  Reduced<EkfCorrection> gradient;
  Reduced<Columns> units;

  // L, X, W, Y and Z
  auto root() { return at<EkfCovariance>(0, moved_before(), moved_before()); }
  auto root() const { return at<EkfCovariance>(0, moved_before(), moved_before()); }
  auto spread() { return at<EkfCovariance>(1, moved_before(), moved()); }
  auto spread() const { return at<EkfCovariance>(1, moved_before(), moved()); }
  auto predicted() { return at<EkfCovariance>(2, moved(), moved()); }
  auto predicted() const { return at<EkfCovariance>(2, moved(), moved()); }
  auto border() { return at<Border>(3, moved_before(), kept()); }
  auto border() const { return at<Border>(3, moved_before(), kept()); }
  auto predicted_border() { return at<Border>(4, moved(), kept()); }
  auto predicted_border() const { return at<Border>(4, moved(), kept()); }
  // T and V of the ambiguities that walk
  auto walk_root() { return at<BorderMatrix>(5, walking(), walking()); }
  auto walk_root() const { return at<BorderMatrix>(5, walking(), walking()); }
  auto walk_rows() { return at<WalkRows>(6, walking(), moved() + kept()); }
  auto walk_rows() const { return at<WalkRows>(6, walking(), moved() + kept()); }

  // Lays the matrices out for the partition.
  void lay_out() {
    const std::array<Index, kMatrices> sizes = {
        moved_before() * moved_before(), moved_before() * moved(), moved() * moved(),
        moved_before() * kept(),         moved() * kept(),         walking() * walking(),
        walking() * (moved() + kept())};
    Index end = 0;
    for (std::size_t i = 0; i < kMatrices; ++i) {
      begins_[i] = end;
      end += (sizes[i] + 1) / 2 * 2;  // each is aligned to kAlignment
    }
  }

 private:
  static constexpr std::size_t kMatrices = 7;
  static constexpr int kAlignment = 2 * sizeof(double);  // bytes, as of new double[]
  static constexpr std::size_t kElements = 3u * kMaxSize * kMaxSize + kMatrices;

  template <typename Matrix>
  View<Matrix> at(std::size_t matrix, Index rows, Index columns) {
    return View<Matrix>(begin_of<Matrix>(matrix), rows, columns);
  }
  template <typename Matrix>
  View<const Matrix> at(std::size_t matrix, Index rows, Index columns) const {
    return View<const Matrix>(begin_of<Matrix>(matrix), rows, columns);
  }
  template <typename Matrix>
  double* begin_of(std::size_t matrix) const {
    static_assert(Eigen::internal::traits<Matrix>::Alignment <= kAlignment);
    return elements_.get() + begins_[matrix];
  }
  Index moved_before() const { return static_cast<Index>(partition.moved_before.size()); }
  Index moved() const { return static_cast<Index>(partition.moved.size()); }
  Index kept() const { return static_cast<Index>(partition.kept.size()); }
  Index walking() const { return static_cast<Index>(partition.walking.size()); }

  std::array<Index, kMatrices> begins_{};
  std::unique_ptr<double[]> elements_ = std::make_unique<double[]>(kElements);
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
  step->lay_out();

  auto root = step->root();
  gather(information_, parts.moved_before, parts.moved_before, &root);
  if (!factorize(&root)) return false;
  const auto lower = root.triangularView<Eigen::Lower>();
  auto border = step->border();
  gather(information_, parts.moved_before, parts.kept_before, &border);
  lower.solveInPlace(border);
  auto spread = step->spread();
  for (std::size_t j = 0; j < parts.moved.size(); ++j)
    for (std::size_t k = 0; k < parts.moved_before.size(); ++k)
      spread(static_cast<Index>(k), static_cast<Index>(j)) =
          process.F(parts.moved[j], parts.moved_before[k]);
  lower.solveInPlace(spread);

  EkfCovariance covariance;
  gather(process.noise, parts.moved, parts.moved, &covariance);
  covariance.selfadjointView<Eigen::Lower>().rankUpdate(spread.transpose());
  covariance.triangularView<Eigen::StrictlyUpper>() = covariance.transpose();
  auto predicted = step->predicted();
  if (!invert(covariance, &predicted)) return false;
  auto predicted_border = step->predicted_border();
  predicted_border.noalias() = spread.transpose() * border;
  step->offset = process.offset;

  BorderMatrix kept;  // S, then A'_bb
  gather(information_, parts.kept_before, parts.kept_before, &kept);
  kept.selfadjointView<Eigen::Lower>().rankUpdate(border.transpose(), -1.0);
  Border coupling;  // A'_xb
  coupling.noalias() = predicted * predicted_border;
  BorderMatrix added;
  added.noalias() = predicted_border.transpose() * coupling;
  kept.triangularView<Eigen::StrictlyUpper>() = kept.transpose();
  kept += added;

  const Index size = keyframe.active.size();
  information_.resize(size, size);
  scatter(predicted, parts.moved, parts.moved, &information_);
  scatter(kept, parts.kept, parts.kept, &information_);
  scatter(coupling, parts.moved, parts.kept, &information_);
  scatter(coupling.transpose(), parts.kept, parts.moved, &information_);
  return walk(process.noise, step);
}

// Leads a right side on, as move_on() leads the information. `offset` is that of the process, or
// empty.
template <typename Rhs>
void RtsSolver::forward(const Step& step, const EkfCorrection& offset, Rhs* rhs,
                        Reduced<Rhs>* reduced) const {
  const Partition& parts = step.partition;
  gather_rows(*rhs, parts.moved_before, &reduced->moved);
  step.root().triangularView<Eigen::Lower>().solveInPlace(reduced->moved);
  Rhs kept;
  gather_rows(*rhs, parts.kept_before, &kept);
  kept.noalias() -= step.border().transpose() * reduced->moved;
  reduced->predicted.noalias() = step.spread().transpose() * reduced->moved;
  if (offset.size() > 0)
    for (std::size_t i = 0; i < parts.moved.size(); ++i)
      reduced->predicted.row(static_cast<Index>(i)).array() -= offset(parts.moved[i]);
  const Rhs moved = step.predicted() * reduced->predicted;
  kept.noalias() += step.predicted_border().transpose() * moved;
  rhs->resize(static_cast<Index>(parts.moved.size() + parts.kept.size()), rhs->cols());
  scatter_rows(moved, parts.moved, rhs);
  scatter_rows(kept, parts.kept, rhs);
  if (parts.walking.empty()) return;
  gather_rows(*rhs, parts.walking, &reduced->walking);
  step.walk_root().triangularView<Eigen::Lower>().solveInPlace(reduced->walking);
  rhs->noalias() -= step.walk_rows().transpose() * reduced->walking;
}

// Leads a solution at the later keyframe back to the earlier one.
template <typename Rhs>
void RtsSolver::backward(const Step& step, const Reduced<Rhs>& reduced, Rhs* solution) const {
  const Partition& parts = step.partition;
  if (!parts.walking.empty()) {
    Rhs walked;
    gather_rows(*solution, parts.walking, &walked);
    for (const int walking : parts.walking) solution->row(walking).setZero();
    walked = step.walk_weight.asDiagonal() * walked;
    step.walk_root().triangularView<Eigen::Lower>().solveInPlace(walked);
    walked += reduced.walking;
    walked.noalias() -= step.walk_rows() * *solution;
    step.walk_root().transpose().triangularView<Eigen::Upper>().solveInPlace(walked);
    scatter_rows(walked, parts.walking, solution);
  }
  Rhs kept;
  gather_rows(*solution, parts.kept, &kept);
  Rhs unexplained;  // x' minus its mean given b
  gather_rows(*solution, parts.moved, &unexplained);
  unexplained -= reduced.predicted;
  unexplained.noalias() += step.predicted_border() * kept;
  Rhs moved = reduced.moved;
  moved.noalias() -= step.border() * kept;
  const Rhs weighed = step.predicted() * unexplained;
  moved.noalias() += step.spread() * weighed;
  step.root().transpose().triangularView<Eigen::Upper>().solveInPlace(moved);
  solution->resize(moved.rows() + kept.rows(), solution->cols());
  scatter_rows(moved, parts.moved_before, solution);
  scatter_rows(kept, parts.kept_before, solution);
}

// Takes away what the random walk of ambiguities makes uncertain.
bool RtsSolver::walk(const EkfCovariance& noise, Step* step) {
  const Indices& walking = step->partition.walking;
  if (walking.empty()) return true;
  const auto count = static_cast<Index>(walking.size());
  auto walk_root = step->walk_root();
  auto walk_rows = step->walk_rows();
  step->walk_weight.resize(count);
  for (Index i = 0; i < count; ++i) {
    const int row = walking[static_cast<std::size_t>(i)];
    for (Index j = 0; j < count; ++j)
      walk_root(i, j) = information_(row, walking[static_cast<std::size_t>(j)]);
    step->walk_weight(i) = 1.0 / noise(row, row);
    walk_root(i, i) += step->walk_weight(i);
    walk_rows.row(i) = information_.row(row);
  }
  const Eigen::LLT<Eigen::Ref<BorderMatrix>, Eigen::Lower> root(walk_root);
  if (root.info() != Eigen::Success) return false;
  const auto lower = walk_root.triangularView<Eigen::Lower>();
  lower.solveInPlace(walk_rows);
  information_.selfadjointView<Eigen::Lower>().rankUpdate(walk_rows.transpose(), -1.0);
  information_.triangularView<Eigen::StrictlyUpper>() = information_.transpose();
  return true;
}

// Solves for the newest keyframe by the root that information_ then is.
template <typename Rhs>
void RtsSolver::solve_newest(Rhs* rhs) const {
  information_.triangularView<Eigen::Lower>().solveInPlace(*rhs);
  information_.transpose().triangularView<Eigen::Upper>().solveInPlace(*rhs);
}

bool RtsSolver::solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
                      WindowCorrections* corrections) {
  size_ = window.size();
  for (int i = 0; i < size_; ++i) {
    collect(window, lever_arm_b, i);
    if (i + 1 == size_) break;
    Step& step = steps_[static_cast<std::size_t>(i)];
    if (!move_on(window, i, &step)) return false;
    lead_gradient(&step);
  }
  if (!factorize(&information_)) return false;
  solve_newest(&gradient_);
  corrections->resize(static_cast<std::size_t>(size_));
  for (int i = size_ - 1; i >= 0; --i) {
    EkfCorrection& correction = (*corrections)[static_cast<std::size_t>(i)];
    if (i + 1 == size_) {
      correction = gradient_;
    } else {
      const Step& step = steps_[static_cast<std::size_t>(i)];
      correction = (*corrections)[static_cast<std::size_t>(i) + 1];
      for (const int state : step.partition.kept) correction(state) += step.offset(state);
      backward(step, step.gradient, &correction);
    }
    if (!correction.allFinite()) return false;
  }
  return true;
}

// From errors of the earlier keyframe's ambiguities to those of the later one's.
void RtsSolver::lead_gradient(Step* step) {
  forward(*step, step->offset, &gradient_, &step->gradient);
  EkfCorrection kept = EkfCorrection::Zero(gradient_.size());
  for (const int state : step->partition.kept) kept(state) = step->offset(state);
  gradient_.noalias() -= information_ * kept;
}

void RtsSolver::oldest_covariance(const Window& window, PoseCovariance* covariance) {
  const ActiveStates& active = window.at(0).active;
  Index poses = 0;
  while (poses < active.core_size() && active.core[static_cast<std::size_t>(poses)] < kPoseStates)
    ++poses;
  Columns units = Columns::Zero(active.size(), poses);
  units.topRows(poses).setIdentity();
  for (int i = 0; i + 1 < size_; ++i) {
    Step& step = steps_[static_cast<std::size_t>(i)];
    forward(step, EkfCorrection(), &units, &step.units);
  }
  solve_newest(&units);
  for (int i = size_ - 2; i >= 0; --i) {
    const Step& step = steps_[static_cast<std::size_t>(i)];
    backward(step, step.units, &units);
  }
  covariance->setZero();
  for (Index i = 0; i < poses; ++i)
    for (Index j = 0; j < poses; ++j)
      (*covariance)(active.core[static_cast<std::size_t>(i)],
                    active.core[static_cast<std::size_t>(j)]) = 0.5 * (units(i, j) + units(j, i));
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
  lead_gradient(&steps_[0]);
  prior->at = window.at(1).state;
  prior->information = information_;
  prior->gradient = gradient_;
  return prior->information.allFinite() && prior->gradient.allFinite();
}

}  // namespace leonav
