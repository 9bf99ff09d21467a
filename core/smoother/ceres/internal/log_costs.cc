#include "core/smoother/ceres/internal/log_costs.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/smoother/linear_process_factor.h"
#include "core/smoother/linearization.h"

namespace leonav {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Turns d / d difference(state, reference) into d / d (change of `state`), in place.
void to_change(const ActiveStates& active, const CoreState& state, const CoreState& reference,
               MatrixXd* jacobian) {
  const AttitudeJacobian change = attitude_jacobian(active, state, reference);
  if (change.index >= 0) columns_times(change.of_error, change.index, jacobian);
}

// A quadratic term 0.5 d^T information d - gradient^T d of a keyframe, d = x - at; `pieces_at` are
// the values of the first of its pieces as far as the term contains them.
class QuadraticCost final : public LogCost {
 public:
  QuadraticCost(const LogGraph& graph, const LogUnknowns& unknowns, int keyframe,
                const CoreState& at, const VectorXd& pieces_at, const MatrixXd& information,
                const VectorXd& gradient)
      : LogCost(graph, unknowns, {keyframe}, first(graph.at(keyframe).pieces, pieces_at.size())),
        at_(at),
        pieces_moved_(pieces_at.size()) {
    constexpr double kNothing = 1e-12;  // times the largest eigenvalue: rounding
    const VectorXd scale = information.diagonal().cwiseMax(0.0).cwiseSqrt();
    const VectorXd inverse = (scale.array() > 0.0).select(scale.cwiseInverse(), 0.0);
    const Eigen::SelfAdjointEigenSolver<MatrixXd> parts(inverse.asDiagonal() * information *
                                                        inverse.asDiagonal());
    const VectorXd& values = parts.eigenvalues();
    const Index rank = (values.array() > kNothing * values.maxCoeff()).count();
    const VectorXd sigma = values.tail(rank).cwiseSqrt();
    const auto directions = parts.eigenvectors().rightCols(rank);
    root_ = sigma.asDiagonal() * directions.transpose() * scale.asDiagonal();
    whitened_gradient_ = sigma.cwiseInverse().asDiagonal() *
                         (directions.transpose() * (inverse.asDiagonal() * gradient));
    for (Index i = 0; i < pieces_moved_.size(); ++i)
      pieces_moved_(i) =
          graph.piece(graph.at(keyframe).pieces[static_cast<std::size_t>(i)]).value_m -
          pieces_at(i);
    usable_ = parts.info() == Eigen::Success && root_.allFinite() && whitened_gradient_.allFinite();
    set_num_residuals(static_cast<int>(rank));
  }

 private:
  static std::vector<int> first(const std::vector<int>& pieces, Index count) {
    return {pieces.begin(), pieces.begin() + count};
  }

  void evaluate(const Evaluation& at) const override {
    const ActiveStates& active = graph_.at(keyframes_[0]).active;
    const Index core = active.core_size(), pieces = pieces_moved_.size();
    *at.residuals = root_.leftCols(core) * active_part(active, difference(at.states[0], at_)) +
                    root_.rightCols(pieces) * (pieces_moved_ + at.pieces) - whitened_gradient_;
    if (at.jacobians == nullptr) return;
    (*at.jacobians)[0] = root_.leftCols(core);
    to_change(active, at.states[0], at_, &(*at.jacobians)[0]);
    *at.of_pieces = root_.rightCols(pieces);
  }

  CoreState at_;
  VectorXd pieces_moved_;
  MatrixXd root_;               // R with R^T R = information, of as many rows as that has rank
  VectorXd whitened_gradient_;  // R^-T gradient
};

// The process factor that leads to keyframe k, for the states that the process moves.
class ProcessCost final : public LogCost {
 public:
  ProcessCost(const LogGraph& graph, const LogUnknowns& unknowns, int k)
      : LogCost(graph, unknowns, {k - 1, k}) {
    const LogProcess& process = graph.at(k).process;
    std::vector<Index> moved;
    for (Index i = 0; i < process.noise.rows(); ++i)
      if (is_moved(process, i)) moved.push_back(i);
    const MatrixXd noise = process.noise(moved, moved);
    const VectorXd scale = noise.diagonal().cwiseSqrt().cwiseInverse();
    const Eigen::LLT<MatrixXd> root(scale.asDiagonal() * noise * scale.asDiagonal());
    usable_ = root.info() == Eigen::Success;
    MatrixXd whitening = scale.asDiagonal();
    root.matrixL().solveInPlace(whitening);
    root_.setZero(whitening.rows(), process.noise.rows());
    for (std::size_t i = 0; i < moved.size(); ++i)
      root_.col(moved[i]) = whitening.col(static_cast<Index>(i));
    root_F_ = root_ * process.F;
    set_num_residuals(static_cast<int>(root_.rows()));
  }

 private:
  void evaluate(const Evaluation& at) const override {
    const LogKeyframe& before = graph_.at(keyframes_[0]);
    const LogKeyframe& keyframe = graph_.at(keyframes_[1]);
    const LogProcess& process = keyframe.process;
    *at.residuals = root_ * active_part(keyframe.active, difference(at.states[1], process.to)) -
                    root_F_ * active_part(before.active, difference(at.states[0], process.from));
    if (at.jacobians == nullptr) return;
    (*at.jacobians)[0] = -root_F_;
    (*at.jacobians)[1] = root_;
    to_change(before.active, at.states[0], process.from, &(*at.jacobians)[0]);
    to_change(keyframe.active, at.states[1], process.to, &(*at.jacobians)[1]);
  }

  MatrixXd root_;  // R with R^T R = N^-1, columns of moved states only
  MatrixXd root_F_;
};

// Measurements of one keyframe: residual times sqrt(factor / variance). Either those without an
// ambiguity, or those of one ambiguity.
class MeasurementsCost final : public LogCost {
 public:
  MeasurementsCost(const LogGraph& graph, const LogUnknowns& unknowns, int k, int piece,
                   std::vector<const LogMeasurement*> measurements, bool factors)
      : LogCost(graph, unknowns, {k}, piece >= 0 ? std::vector<int>{piece} : std::vector<int>{}),
        measurements_(std::move(measurements)),
        factors_(factors) {
    set_num_residuals(static_cast<int>(measurements_.size()));
  }

  double gain_to_test_sigma() const override {
    if (measurements_.size() != 1) return 0.0;
    return std::sqrt(measurements_[0]->gain_variance / measurements_[0]->variance);
  }

 private:
  void evaluate(const Evaluation& at) const override {
    const LogKeyframe& keyframe = graph_.at(keyframes_[0]);
    const ActiveStates& active = keyframe.active;
    const CoreState& state = at.states[0];
    const AntennaMotion antenna = antenna_of(keyframe, state, graph_.lever_arm_b());
    for (Index i = 0; i < at.residuals->size(); ++i) {
      const LogMeasurement& measurement = *measurements_[static_cast<std::size_t>(i)];
      const double factor = factors_ ? measurement.factor : 1.0;
      const double root = std::sqrt(factor / measurement.gain_variance);
      const LinearMeasurement linear =
          linearize(measurement.measurement,
                    keyframe.satellites[measurement.measurement.satellite_index], state, antenna);
      double residual = linear.residual;
      if (measurement.piece >= 0)
        residual -=
            graph_.piece(measurement.piece).value_m + at.pieces(0) + measurement.ambiguity_offset_m;
      (*at.residuals)(i) = -root * residual;
      if (at.jacobians == nullptr) continue;
      for (Index j = 0; j < active.core_size(); ++j)
        (*at.jacobians)[0](i, j) = root * row_of(linear, active.core[static_cast<std::size_t>(j)]);
      if (at.of_pieces->cols() > 0) (*at.of_pieces)(i, 0) = root;
    }
  }

  std::vector<const LogMeasurement*> measurements_;
  bool factors_;
};

// Two pieces whose arcs the filter has joined.
class JoinCost final : public LogCost {
 public:
  JoinCost(const LogGraph& graph, const LogUnknowns& unknowns, const PieceJoin& join)
      : LogCost(graph, unknowns, {}, {join.from, join.to}),
        weight_(1.0 / std::sqrt(join.variance)),
        shift_m_(graph.piece(join.to).value_m - graph.piece(join.from).value_m -
                 join.difference_m) {
    set_num_residuals(1);
  }

 private:
  void evaluate(const Evaluation& at) const override {
    (*at.residuals)(0) = weight_ * (shift_m_ + at.pieces(1) - at.pieces(0));
    if (at.jacobians == nullptr) return;
    (*at.of_pieces)(0, 0) = -weight_;
    (*at.of_pieces)(0, 1) = weight_;
  }

  double weight_, shift_m_;
};

}  // namespace

LogCost::LogCost(const LogGraph& graph, const LogUnknowns& unknowns, std::vector<int> keyframes,
                 std::vector<int> pieces)
    : graph_(graph),
      keyframes_(std::move(keyframes)),
      unknowns_(unknowns),
      pieces_(std::move(pieces)) {
  for (const int k : keyframes_)
    for (const LogUnknowns::Entry& entry : unknowns.entries(k)) blocks_.push_back(entry.block);
  std::sort(blocks_.begin(), blocks_.end());
  blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
  for (const int k : keyframes_) {
    std::vector<int> slots;
    for (const LogUnknowns::Entry& entry : unknowns.entries(k))
      slots.push_back(static_cast<int>(
          std::lower_bound(blocks_.begin(), blocks_.end(), entry.block) - blocks_.begin()));
    slots_.push_back(slots);
  }
  for (const int piece : pieces_) blocks_.push_back(unknowns.block_of_piece(piece));
  for (const int block : blocks_)
    mutable_parameter_block_sizes()->push_back(unknowns.size_of(block));
}

bool LogCost::Evaluate(double const* const* parameters, double* residuals,
                       double** jacobians) const {
  const std::size_t count = keyframes_.size();
  Evaluation at;
  std::vector<MatrixXd> of_changes(count);
  const std::size_t first_piece = blocks_.size() - pieces_.size();
  MatrixXd of_pieces = MatrixXd::Zero(num_residuals(), static_cast<Index>(pieces_.size()));
  VectorXd values(num_residuals());
  at.residuals = &values;
  at.jacobians = jacobians != nullptr ? &of_changes : nullptr;
  at.of_pieces = &of_pieces;
  at.pieces.resize(of_pieces.cols());
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    at.pieces(static_cast<Index>(i)) = parameters[first_piece + i][0];
  for (std::size_t i = 0; i < count; ++i) {
    const LogKeyframe& keyframe = graph_.at(keyframes_[i]);
    const LogUnknowns::Entries& entries = unknowns_.entries(keyframes_[i]);
    EkfCorrection error(keyframe.core_size());
    for (std::size_t j = 0; j < entries.size(); ++j)
      error(static_cast<Index>(j)) =
          parameters[slots_[i][j]][entries[j].offset] + entries[j].constant;
    at.states.push_back(keyframe.state);
    add(full_error(keyframe.active, error), keyframe.has_attitude, &at.states.back());
    if (jacobians != nullptr) of_changes[i].resize(num_residuals(), keyframe.core_size());
  }
  evaluate(at);
  VectorXd::Map(residuals, num_residuals()) = values;
  if (jacobians == nullptr) return values.allFinite();
  for (std::size_t slot = 0; slot < blocks_.size(); ++slot)
    if (jacobians[slot] != nullptr)
      std::fill_n(jacobians[slot], num_residuals() * unknowns_.size_of(blocks_[slot]), 0.0);
  for (std::size_t i = 0; i < count; ++i) {
    const LogKeyframe& keyframe = graph_.at(keyframes_[i]);
    // The unknowns are differences from the estimate.
    const AttitudeJacobian change =
        attitude_jacobian(keyframe.active, at.states[i], keyframe.state);
    if (change.index >= 0) columns_times(change.to_error, change.index, &of_changes[i]);
    const LogUnknowns::Entries& entries = unknowns_.entries(keyframes_[i]);
    for (std::size_t j = 0; j < entries.size(); ++j) {
      double* jacobian = jacobians[slots_[i][j]];
      if (jacobian == nullptr) continue;
      Eigen::Map<RowMajor>(jacobian, num_residuals(), unknowns_.size_of(entries[j].block))
          .col(entries[j].offset) += of_changes[i].col(static_cast<Index>(j));
    }
  }
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    if (jacobians[first_piece + i] != nullptr)
      VectorXd::Map(jacobians[first_piece + i], num_residuals()) =
          of_pieces.col(static_cast<Index>(i));
  return values.allFinite();
}

bool make_costs(const LogGraph& graph, const LogUnknowns& unknowns, bool factors,
                std::vector<std::unique_ptr<LogCost>>* costs) {
  for (int k = 0; k < graph.size(); ++k) {
    const LogKeyframe& keyframe = graph.at(k);
    const LogProcess& process = keyframe.process;
    if (keyframe.prior_information.size() > 0)
      costs->push_back(std::make_unique<QuadraticCost>(
          graph, unknowns, k, keyframe.prior_at, keyframe.prior_pieces_at,
          keyframe.prior_information, keyframe.prior_gradient));
    if (process.exists) costs->push_back(std::make_unique<ProcessCost>(graph, unknowns, k));
    if (process.information.size() > 0)
      costs->push_back(std::make_unique<QuadraticCost>(
          graph, unknowns, k - 1, process.from, VectorXd(), process.information, process.gradient));
    for (const PieceJoin& join : process.joins)
      costs->push_back(std::make_unique<JoinCost>(graph, unknowns, join));
    std::vector<const LogMeasurement*> plain;
    for (const LogMeasurement& measurement : keyframe.measurements) {
      if (factors && !(measurement.factor > 0.0)) continue;
      if (measurement.piece < 0 && factors)
        plain.push_back(&measurement);
      else
        costs->push_back(std::make_unique<MeasurementsCost>(
            graph, unknowns, k, measurement.piece, std::vector<const LogMeasurement*>{&measurement},
            factors));
    }
    if (!plain.empty())
      costs->push_back(std::make_unique<MeasurementsCost>(graph, unknowns, k, -1, plain, factors));
  }
  return std::all_of(costs->begin(), costs->end(),
                     [](const std::unique_ptr<LogCost>& cost) { return cost->usable(); });
}

PieceCost::PieceCost(const AmbiguityPiece& piece, const AmbiguityPiece* before)
    : shift_m_(piece.value_m - (before != nullptr ? before->value_m : piece.start_value_m)),
      weight_(1.0 / std::sqrt(piece.step_variance)),
      follows_(before != nullptr) {
  set_num_residuals(1);
  mutable_parameter_block_sizes()->assign(follows_ ? 2 : 1, 1);
}

bool PieceCost::Evaluate(double const* const* parameters, double* residuals,
                         double** jacobians) const {
  residuals[0] = weight_ * (parameters[0][0] + shift_m_ - (follows_ ? parameters[1][0] : 0.0));
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) jacobians[0][0] = weight_;
  if (follows_ && jacobians[1] != nullptr) jacobians[1][0] = -weight_;
  return true;
}

}  // namespace leonav
