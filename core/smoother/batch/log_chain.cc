#include "core/smoother/batch/log_chain.h"

#include <algorithm>

#include "core/base/square.h"
#include "core/smoother/batch/internal/log_linear.h"
#include "core/smoother/internal/definite_inverse.h"

namespace leonav {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kForwardShare = 0.6;  // of the time, roughly

// What the keyframes up to one say of it.
struct Filtered {
  MatrixXd covariance;  // P_k, with the constraints behind it
  VectorXd error;
};

// What the backward pass needs of a keyframe.
struct Step {
  Filtered filtered;
  MatrixXd spread;  // T P_(k-1), with T the transition to this keyframe
  MatrixXd predicted_information;
  MatrixXd predicted;  // T P_(k-1) T^T + N
  VectorXd predicted_error;
};

// Where a piece comes from at the keyframe before, as an index of that one's pieces.
struct Origin {
  Index before = -1;  // -1: it begins here
  double added_variance = 0.0, shift_m = 0.0;
};

Origin origin_of(const LogGraph& graph, const LogKeyframe& before, int piece) {
  const auto find = [&](int wanted) {
    const auto found = std::lower_bound(before.pieces.begin(), before.pieces.end(), wanted);
    return found != before.pieces.end() && *found == wanted ? found - before.pieces.begin() : -1;
  };
  Origin origin;
  origin.before = find(piece);
  if (origin.before >= 0) return origin;
  const AmbiguityPiece& self = graph.piece(piece);
  origin.added_variance = self.step_variance;
  if (self.previous >= 0) origin.before = find(self.previous);
  const double expected =
      origin.before >= 0 ? graph.piece(self.previous).value_m : self.start_value_m;
  origin.shift_m = expected - self.value_m;
  return origin;
}

void predict(const LogGraph& graph, int k, const Filtered& last, Step* step) {
  const LogKeyframe& before = graph.at(k - 1);
  const LogKeyframe& keyframe = graph.at(k);
  const LogLinearProcess process = linearize_process(graph, k);
  const Index core = keyframe.core_size(), core_before = before.core_size();
  const Index size = keyframe.size(), size_before = before.size();
  std::vector<Origin> origins;
  for (const int piece : keyframe.pieces) origins.push_back(origin_of(graph, before, piece));
  step->spread.setZero(size, size_before);
  step->predicted_error.resize(size);
  step->spread.topRows(core).noalias() = process.F * last.covariance.topRows(core_before);
  step->predicted_error.head(core) = process.F * last.error.head(core_before) - process.offset;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const Index row = core + static_cast<Index>(i);
    step->predicted_error(row) = origins[i].shift_m;
    if (origins[i].before < 0) continue;
    step->spread.row(row) = last.covariance.row(core_before + origins[i].before);
    step->predicted_error(row) += last.error(core_before + origins[i].before);
  }
  step->predicted.resize(size, size);
  step->predicted.leftCols(core).noalias() =
      step->spread.leftCols(core_before) * process.F.transpose();
  step->predicted.topLeftCorner(core, core) += process.noise;
  for (std::size_t i = 0; i < origins.size(); ++i) {
    const Index column = core + static_cast<Index>(i);
    if (origins[i].before >= 0)
      step->predicted.col(column) = step->spread.col(core_before + origins[i].before);
    else
      step->predicted.col(column).setZero();
    step->predicted(column, column) += origins[i].added_variance;
  }
  step->predicted.topRightCorner(core, size - core) =
      step->predicted.bottomLeftCorner(size - core, core).transpose();
}

bool solve(const LogInformation& sum, Filtered* filtered) {
  if (!invert(sum.matrix, &filtered->covariance)) return false;
  filtered->error.noalias() = filtered->covariance * sum.gradient;
  return filtered->error.allFinite();
}

// The forward estimate of a keyframe lacks what the constraints up to the next say of it.
bool update(const LogGraph& graph, int k, Step* step, LogCorrections* corrections) {
  const Index size = graph.at(k).size();
  LogInformation sum{MatrixXd::Zero(size, size), VectorXd::Zero(size)};
  if (graph.at(k).process.exists) {
    if (!invert(step->predicted, &step->predicted_information)) return false;
    sum.matrix = step->predicted_information;
    sum.gradient.noalias() = step->predicted_information * step->predicted_error;
  } else {
    const LogKeyframe& keyframe = graph.at(k);
    for (std::size_t i = 0; i < keyframe.pieces.size(); ++i) {
      const Index row = keyframe.core_size() + static_cast<Index>(i);
      sum.matrix(row, row) = 1.0 / graph.piece(keyframe.pieces[i]).step_variance;
    }
  }
  add_information(graph, k, &sum);
  Filtered& filtered = step->filtered;
  if (!solve(sum, &filtered)) return false;
  const Index core = graph.at(k).core_size();
  corrections->filtered_core[static_cast<std::size_t>(k)] = filtered.error.head(core);
  corrections->filtered_covariance[static_cast<std::size_t>(k)] =
      filtered.covariance.topLeftCorner(core, core);
  return !add_constraints(graph, k, &sum) || solve(sum, &filtered);
}

// Forward pass over a segment from what is known of the keyframe before it.
bool pass_forward(const LogGraph& graph, int begin, int end, const Filtered& before,
                  std::vector<Step>* steps, LogCorrections* corrections) {
  steps->resize(static_cast<std::size_t>(end - begin));
  const Filtered* last = &before;
  for (int k = begin; k < end; ++k) {
    Step& step = (*steps)[static_cast<std::size_t>(k - begin)];
    if (graph.at(k).process.exists) predict(graph, k, *last, &step);
    if (!update(graph, k, &step, corrections)) return false;
    last = &step.filtered;
  }
  return true;
}

}  // namespace

bool solve_chain(const LogGraph& graph, const std::function<void(double)>& progress,
                 LogCorrections* corrections, int segment) {
  const int size = graph.size();
  if (size == 0) return false;
  const auto keyframes = static_cast<std::size_t>(size);
  corrections->core.resize(keyframes);
  corrections->covariance.resize(keyframes);
  corrections->filtered_core.resize(keyframes);
  corrections->filtered_covariance.resize(keyframes);
  corrections->pieces.setZero(static_cast<Index>(graph.pieces().size()));
  // The forward pass leaves the steps of the last segment; what is known at the begin of each gives
  // those of the others again, bit for bit.
  std::vector<Step> steps;
  std::vector<Filtered> before(1);  // of each segment
  for (int begin = 0; begin < size; begin += segment) {
    const int end = std::min(size, begin + segment);
    if (!pass_forward(graph, begin, end, before.back(), &steps, corrections)) return false;
    if (end < size) before.push_back(steps.back().filtered);
    progress(kForwardShare * end / size);
  }
  Step beyond;  // the first one of the segment behind
  VectorXd error;
  MatrixXd covariance;
  for (int i = static_cast<int>(before.size()) - 1; i >= 0; --i) {
    const int begin = i * segment, end = std::min(size, begin + segment);
    if (end < size &&
        !pass_forward(graph, begin, end, before[static_cast<std::size_t>(i)], &steps, corrections))
      return false;
    for (int k = end - 1; k >= begin; --k) {
      const auto place = static_cast<std::size_t>(k - begin);
      const Filtered& filtered = steps[place].filtered;
      if (k + 1 == size || !graph.at(k + 1).process.exists) {
        error = filtered.error;
        covariance = filtered.covariance;
      } else {
        const Step& next = k + 1 < end ? steps[place + 1] : beyond;
        const MatrixXd gain = next.spread.transpose() * next.predicted_information;
        error = filtered.error + gain * (error - next.predicted_error);
        covariance = filtered.covariance + gain * (covariance - next.predicted) * gain.transpose();
      }
      const LogKeyframe& keyframe = graph.at(k);
      const Index core = keyframe.core_size();
      const auto at = static_cast<std::size_t>(k);
      corrections->core[at] = error.head(core);
      corrections->covariance[at] = covariance.topLeftCorner(core, core);
      for (std::size_t j = 0; j < keyframe.pieces.size(); ++j)
        corrections->pieces(keyframe.pieces[j]) = error(core + static_cast<Index>(j));
    }
    beyond = std::move(steps.front());
    progress(1.0 - (1.0 - kForwardShare) * begin / size);
  }
  return true;
}

}  // namespace leonav
