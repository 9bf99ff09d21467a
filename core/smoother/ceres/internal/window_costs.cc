#include "core/smoother/ceres/internal/window_costs.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "core/smoother/linear_process_factor.h"
#include "core/smoother/linearization.h"

namespace leonav {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Turns d / d (change of `state`) into d / d difference(state, reference), in place.
void to_difference(const ActiveStates& active, const FilterState& state,
                   const FilterState& reference, MatrixXd* jacobian) {
  const AttitudeJacobian change = attitude_jacobian(active, state, reference);
  if (change.index < 0) return;
  auto columns = jacobian->middleCols<3>(change.index);
  columns = (columns * change.to_error).eval();
}

// Turns d / d difference(state, reference) into d / d (change of `state`), in place.
void to_change(const ActiveStates& active, const FilterState& state, const FilterState& reference,
               MatrixXd* jacobian) {
  const AttitudeJacobian change = attitude_jacobian(active, state, reference);
  if (change.index < 0) return;
  auto columns = jacobian->middleCols<3>(change.index);
  columns = (columns * change.of_error).eval();
}

}  // namespace

WindowCost::WindowCost(const Window& window, const WindowUnknowns& unknowns,
                       std::vector<int> keyframes)
    : window_(window), keyframes_(std::move(keyframes)), unknowns_(unknowns) {
  for (const int k : keyframes_)
    for (const WindowUnknowns::BlockEntry& entry : unknowns.entries(k))
      blocks_.push_back(entry.block);
  std::sort(blocks_.begin(), blocks_.end());
  blocks_.erase(std::unique(blocks_.begin(), blocks_.end()), blocks_.end());
  slot_.assign(static_cast<std::size_t>(blocks_.back()) + 1, -1);
  for (std::size_t slot = 0; slot < blocks_.size(); ++slot) {
    slot_[static_cast<std::size_t>(blocks_[slot])] = static_cast<int>(slot);
    mutable_parameter_block_sizes()->push_back(static_cast<int>(unknowns.size_of(blocks_[slot])));
  }
}

bool WindowCost::Evaluate(double const* const* parameters, double* residuals,
                          double** jacobians) const {
  std::vector<LinearizedKeyframe> at(keyframes_.size());
  std::vector<MatrixXd> of_errors(keyframes_.size());
  for (std::size_t i = 0; i < keyframes_.size(); ++i) {
    const Keyframe& keyframe = window_.at(keyframes_[i]);
    const WindowUnknowns::BlockEntries& entries = unknowns_.entries(keyframes_[i]);
    at[i].error.resize(keyframe.active.size());
    for (Index j = 0; j < at[i].error.size(); ++j) {
      const WindowUnknowns::BlockEntry& entry = entries[static_cast<std::size_t>(j)];
      const int slot = slot_[static_cast<std::size_t>(entry.block)];
      at[i].error(j) = parameters[slot][entry.offset] + entry.constant;
    }
    at[i].state = keyframe.state;
    add(full_error(keyframe.active, at[i].error), keyframe.has_attitude, &at[i].state);
    of_errors[i].setZero(num_residuals(), keyframe.active.size());
  }
  VectorXd values = VectorXd::Zero(num_residuals());
  evaluate(at, &values, &of_errors);
  VectorXd::Map(residuals, num_residuals()) = values;
  if (jacobians != nullptr) {
    for (std::size_t slot = 0; slot < blocks_.size(); ++slot)
      if (jacobians[slot] != nullptr)
        std::fill_n(jacobians[slot], num_residuals() * unknowns_.size_of(blocks_[slot]), 0.0);
    for (std::size_t i = 0; i < keyframes_.size(); ++i) {
      const Keyframe& keyframe = window_.at(keyframes_[i]);
      to_difference(keyframe.active, at[i].state, keyframe.state, &of_errors[i]);
      scatter(of_errors[i], unknowns_.entries(keyframes_[i]), jacobians);
    }
  }
  return values.allFinite();
}

void WindowCost::scatter(const MatrixXd& of_error, const WindowUnknowns::BlockEntries& entries,
                         double** jacobians) const {
  for (Index j = 0; j < of_error.cols(); ++j) {
    const WindowUnknowns::BlockEntry& entry = entries[static_cast<std::size_t>(j)];
    double* jacobian = jacobians[slot_[static_cast<std::size_t>(entry.block)]];
    if (jacobian == nullptr) continue;
    Eigen::Map<RowMajor>(jacobian, num_residuals(), unknowns_.size_of(entry.block))
        .col(entry.offset) += of_error.col(j);
  }
}

PriorCost::PriorCost(const Window& window, const WindowUnknowns& unknowns)
    : WindowCost(window, unknowns, {0}) {
  const WindowPrior& prior = window.prior();
  const Eigen::LLT<MatrixXd> root{MatrixXd(prior.information)};
  usable_ = root.info() == Eigen::Success;
  root_ = root.matrixU();
  whitened_gradient_ = root.matrixL().solve(VectorXd(prior.gradient));
  set_num_residuals(static_cast<int>(root_.rows()));
}

void PriorCost::evaluate(const std::vector<LinearizedKeyframe>& at, VectorXd* residuals,
                         std::vector<MatrixXd>* jacobians) const {
  const Keyframe& oldest = window_.at(0);
  const FilterState& reference = window_.prior().at;
  const VectorXd moved = active_part(oldest.active, difference(at[0].state, reference));
  *residuals = root_ * moved - whitened_gradient_;
  (*jacobians)[0] = root_;
  to_change(oldest.active, at[0].state, reference, &(*jacobians)[0]);
}

ProcessCost::ProcessCost(const Window& window, const WindowUnknowns& unknowns, int k)
    : WindowCost(window, unknowns, {k - 1, k}) {
  const ProcessFactor& process_factor = window.at(k).process_factor;
  std::vector<Index> moved;
  for (Index i = 0; i < process_factor.noise.rows(); ++i)
    if (is_moved(process_factor, i)) moved.push_back(i);
  const MatrixXd noise = process_factor.noise(moved, moved);
  const VectorXd scale = noise.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<MatrixXd> root(scale.asDiagonal() * noise * scale.asDiagonal());
  usable_ = root.info() == Eigen::Success;
  MatrixXd whitening = scale.asDiagonal();
  root.matrixL().solveInPlace(whitening);
  root_.setZero(whitening.rows(), process_factor.noise.rows());
  for (std::size_t i = 0; i < moved.size(); ++i)
    root_.col(moved[i]) = whitening.col(static_cast<Index>(i));
  set_num_residuals(static_cast<int>(root_.rows()));
}

void ProcessCost::evaluate(const std::vector<LinearizedKeyframe>& at, VectorXd* residuals,
                           std::vector<MatrixXd>* jacobians) const {
  const Keyframe& before = window_.at(keyframes_[0]);
  const Keyframe& keyframe = window_.at(keyframes_[1]);
  const ProcessFactor& process_factor = keyframe.process_factor;
  const VectorXd then = active_part(before.active, difference(at[0].state, process_factor.from));
  const VectorXd now = active_part(keyframe.active, difference(at[1].state, process_factor.to));
  *residuals = root_ * (now - process_factor.F * then);
  (*jacobians)[0] = -root_ * process_factor.F;
  (*jacobians)[1] = root_;
  to_change(before.active, at[0].state, process_factor.from, &(*jacobians)[0]);
  to_change(keyframe.active, at[1].state, process_factor.to, &(*jacobians)[1]);
}

InformationCost::InformationCost(const Window& window, const WindowUnknowns& unknowns, int k)
    : WindowCost(window, unknowns, {k - 1}), process_factor_(window.at(k).process_factor) {
  constexpr double kNothing = 1e-12;  // times the largest eigenvalue: rounding
  const MatrixXd information = process_factor_.information;
  const VectorXd scale = information.diagonal().cwiseMax(0.0).cwiseSqrt();
  const VectorXd inverse = (scale.array() > 0.0).select(scale.cwiseInverse(), 0.0);
  const Eigen::SelfAdjointEigenSolver<MatrixXd> parts(inverse.asDiagonal() * information *
                                                      inverse.asDiagonal());
  const VectorXd& values = parts.eigenvalues();
  const Index rank = (values.array() > kNothing * values.maxCoeff()).count();
  const VectorXd sigma = values.tail(rank).cwiseSqrt();
  const auto directions = parts.eigenvectors().rightCols(rank);
  root_ = sigma.asDiagonal() * directions.transpose() * scale.asDiagonal();
  whitened_gradient_ =
      sigma.cwiseInverse().asDiagonal() *
      (directions.transpose() * (inverse.asDiagonal() * VectorXd(process_factor_.gradient)));
  usable_ = parts.info() == Eigen::Success && root_.allFinite() && whitened_gradient_.allFinite();
  set_num_residuals(static_cast<int>(rank));
}

void InformationCost::evaluate(const std::vector<LinearizedKeyframe>& at, VectorXd* residuals,
                               std::vector<MatrixXd>* jacobians) const {
  const Keyframe& before = window_.at(keyframes_[0]);
  *residuals = root_ * active_part(before.active, difference(at[0].state, process_factor_.from)) -
               whitened_gradient_;
  (*jacobians)[0] = root_;
  to_change(before.active, at[0].state, process_factor_.from, &(*jacobians)[0]);
}

MeasurementsCost::MeasurementsCost(const Window& window, const WindowUnknowns& unknowns, int k,
                                   const Eigen::Vector3d& lever_arm_b)
    : WindowCost(window, unknowns, {k}), lever_arm_b_(lever_arm_b) {
  for (const KeyframeMeasurement& measurement : window.at(k).measurements)
    if (measurement.factor > 0.0) used_.push_back(&measurement);
  set_num_residuals(static_cast<int>(used_.size()));
}

void MeasurementsCost::evaluate(const std::vector<LinearizedKeyframe>& at, VectorXd* residuals,
                                std::vector<MatrixXd>* jacobians) const {
  const auto keyframe = std::make_unique<Keyframe>(window_.at(keyframes_[0]));
  keyframe->state = at[0].state;
  const ActiveStates& active = keyframe->active;
  const AntennaMotion antenna = antenna_of(*keyframe, lever_arm_b_);
  MatrixXd& jacobian = (*jacobians)[0];
  for (Index i = 0; i < residuals->size(); ++i) {
    const KeyframeMeasurement& measurement = *used_[static_cast<std::size_t>(i)];
    const double root = std::sqrt(measurement.factor / measurement.gain_variance);
    const LinearMeasurement linear = linearize(measurement, *keyframe, antenna);
    (*residuals)(i) = -root * linear.residual;
    for (Index j = 0; j < active.core_size(); ++j)
      jacobian(i, j) = root * row_of(linear, active.core[static_cast<std::size_t>(j)]);
    if (measurement.signal_state >= 0)
      jacobian(i, active.core_size() + measurement.signal_state) = root;
  }
}

}  // namespace leonav
