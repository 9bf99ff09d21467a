// A whole log as one problem of whitened rows, solved by QR: what the chain must come to.
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <utility>
#include <vector>

#include "core/smoother/batch/log_graph.h"
#include "core/smoother/linearization.h"
#include "support/dense/dense_algebra.h"

namespace leonav::synthetic {

// The step to the minimum at a graph's estimates, with its covariance: core states by keyframe,
// then the pieces.
struct DenseLog {
  Eigen::VectorXd correction;
  Eigen::MatrixXd covariance;
  std::vector<Eigen::Index> first;  // of each keyframe, then of the pieces

  Eigen::VectorXd core(int k) const { return correction.segment(from(k), size_of(k)); }
  Eigen::MatrixXd core_covariance(int k) const {
    return covariance.block(from(k), from(k), size_of(k), size_of(k));
  }
  Eigen::VectorXd pieces() const { return correction.tail(correction.size() - first.back()); }
  Eigen::VectorXd piece_sigmas() const {
    return covariance.diagonal().tail(correction.size() - first.back()).cwiseSqrt();
  }

 private:
  Eigen::Index from(int k) const { return first[static_cast<std::size_t>(k)]; }
  Eigen::Index size_of(int k) const { return first[static_cast<std::size_t>(k) + 1] - from(k); }
};

// How an error of `state` changes its difference from `reference`: by central differences where the
// attitudes differ, the identity elsewhere.
inline Eigen::MatrixXd slope_of_difference(const LogKeyframe& keyframe, const CoreState& state,
                                           const CoreState& reference) {
  constexpr double kStep = 1e-4;  // rad
  const ActiveStates& active = keyframe.active;
  Eigen::MatrixXd slope = Eigen::MatrixXd::Identity(active.core_size(), active.core_size());
  const Eigen::Quaterniond turned = state.nav.q_eb * reference.nav.q_eb.conjugate();
  if (!keyframe.has_attitude || turned.vec().norm() == 0.0) return slope;
  for (Eigen::Index j = 0; j < active.core_size(); ++j) {
    const int column = active.core[static_cast<std::size_t>(j)];
    if (column < ekf_index::kAttitude || column >= ekf_index::kAttitude + 3) continue;
    const auto moved = [&](double by) {
      EkfCorrection error = EkfCorrection::Zero(state.size());
      error(column) = by;
      CoreState other = state;
      add(error, true, &other);
      return active_part(active, difference(other, reference));
    };
    slope.col(j) = (moved(kStep) - moved(-kStep)) / (2.0 * kStep);
  }
  return slope;
}

// Rows of whitened equations, appended one block after the other.
class DenseRows {
 public:
  explicit DenseRows(Eigen::Index states) : states_(states) {}

  // root^T root is the information of root x = value.
  struct Part {
    Eigen::Index first;
    Eigen::MatrixXd matrix;
  };
  void add(const std::vector<Part>& parts, const Eigen::VectorXd& value) {
    if (used_ + value.size() > matrix_.rows()) {
      matrix_.conservativeResize(2 * (used_ + value.size()), states_);
      value_.conservativeResize(matrix_.rows());
    }
    matrix_.middleRows(used_, value.size()).setZero();
    for (const Part& part : parts)
      matrix_.block(used_, part.first, value.size(), part.matrix.cols()) += part.matrix;
    value_.segment(used_, value.size()) = value;
    used_ += value.size();
  }
  // 0.5 d^T information d - gradient^T d, with d = moved + slope e. The information may lack rank.
  // d is made of a keyframe's core states, from column `first` on, and of pieces, from
  // `first_piece`.
  void add_quadratic(Eigen::Index first, const Eigen::MatrixXd& slope, const Eigen::VectorXd& moved,
                     const Eigen::MatrixXd& information, const Eigen::VectorXd& gradient,
                     Eigen::Index first_piece = 0) {
    constexpr double kNothing = 1e-13;  // times the largest eigenvalue
    const Eigen::VectorXd scale =
        information.diagonal().unaryExpr([](double x) { return x > 0.0 ? std::sqrt(x) : 1.0; });
    const dense::SymmetricParts parts = dense::symmetric_parts(
        scale.cwiseInverse().asDiagonal() * information * scale.cwiseInverse().asDiagonal());
    const Eigen::VectorXd& values = parts.eigenvalues;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      if (!(values(i) > kNothing * values.maxCoeff())) continue;
      const double sigma = std::sqrt(values(i));
      const Eigen::VectorXd direction = parts.eigenvectors.col(i);
      const Eigen::RowVectorXd root = sigma * direction.cwiseProduct(scale).transpose();
      Eigen::VectorXd value(1);
      value(0) = direction.dot(scale.cwiseInverse().cwiseProduct(gradient)) / sigma - root * moved;
      const Eigen::Index core = slope.rows(), pieces = moved.size() - core;
      std::vector<Part> of_states = {{first, root.head(core) * slope}};
      if (pieces > 0) of_states.push_back({first_piece, root.tail(pieces)});
      add(of_states, value);
    }
  }
  void solve(DenseLog* log) const {
    dense::LeastSquares fit = dense::least_squares(matrix_.topRows(used_), value_.head(used_));
    log->correction = std::move(fit.solution);
    log->covariance = std::move(fit.covariance);
  }

 private:
  Eigen::Index states_, used_ = 0;
  Eigen::MatrixXd matrix_;
  Eigen::VectorXd value_;
};

inline void add_process_rows(const LogGraph& graph, int k, const DenseLog& log, DenseRows* rows) {
  const LogKeyframe& before = graph.at(k - 1);
  const LogKeyframe& keyframe = graph.at(k);
  const LogProcess& process = keyframe.process;
  const Eigen::Index first_before = log.first[static_cast<std::size_t>(k) - 1];
  const Eigen::MatrixXd root = dense::whitening(process.noise);
  const Eigen::VectorXd to = active_part(keyframe.active, difference(keyframe.state, process.to));
  const Eigen::VectorXd from = active_part(before.active, difference(before.state, process.from));
  const Eigen::MatrixXd slope_before = slope_of_difference(before, before.state, process.from);
  rows->add({{log.first[static_cast<std::size_t>(k)],
              root * slope_of_difference(keyframe, keyframe.state, process.to)},
             {first_before, -root * process.F * slope_before}},
            -root * (to - process.F * from));
  if (process.information.size() > 0)
    rows->add_quadratic(first_before, slope_before, from, process.information, process.gradient);
  for (const PieceJoin& join : process.joins) {
    const Eigen::MatrixXd weight = Eigen::MatrixXd::Constant(1, 1, 1.0 / std::sqrt(join.variance));
    const double residual =
        join.difference_m - (graph.piece(join.to).value_m - graph.piece(join.from).value_m);
    rows->add({{log.first.back() + join.to, weight}, {log.first.back() + join.from, -weight}},
              residual * weight.col(0));
  }
}

inline void add_measurement_rows(const LogGraph& graph, int k, const DenseLog& log,
                                 DenseRows* rows) {
  const LogKeyframe& keyframe = graph.at(k);
  const AntennaMotion antenna = antenna_of(keyframe, keyframe.state, graph.lever_arm_b());
  for (const LogMeasurement& m : keyframe.measurements) {
    const double root = std::sqrt(m.factor / m.gain_variance);
    const LinearMeasurement linear = linearize(
        m.measurement, keyframe.satellites[m.measurement.satellite_index], keyframe.state, antenna);
    Eigen::RowVectorXd row(keyframe.core_size());
    for (Eigen::Index i = 0; i < row.size(); ++i)
      row(i) = root * row_of(linear, keyframe.active.core[static_cast<std::size_t>(i)]);
    std::vector<DenseRows::Part> parts = {{log.first[static_cast<std::size_t>(k)], row}};
    double residual = linear.residual;
    if (m.piece >= 0) {
      residual -= graph.piece(m.piece).value_m + m.ambiguity_offset_m;
      parts.push_back({log.first.back() + m.piece, Eigen::MatrixXd::Constant(1, 1, root)});
    }
    rows->add(parts, Eigen::VectorXd::Constant(1, root * residual));
  }
}

inline void add_step_of_piece(const LogGraph& graph, int i, const DenseLog& log, DenseRows* rows) {
  const AmbiguityPiece& piece = graph.piece(i);
  const double root = 1.0 / std::sqrt(piece.step_variance);
  std::vector<DenseRows::Part> parts = {
      {log.first.back() + i, Eigen::MatrixXd::Constant(1, 1, root)}};
  double expected = piece.start_value_m;
  if (piece.previous >= 0) {
    expected = graph.piece(piece.previous).value_m;
    parts.push_back({log.first.back() + piece.previous, Eigen::MatrixXd::Constant(1, 1, -root)});
  }
  rows->add(parts, Eigen::VectorXd::Constant(1, root * (expected - piece.value_m)));
}

// The pieces of a keyframe with a prior begin there, one after the other.
inline void add_prior_rows(const LogGraph& graph, int k, const DenseLog& log, DenseRows* rows) {
  const LogKeyframe& keyframe = graph.at(k);
  Eigen::VectorXd moved(keyframe.size());
  moved.head(keyframe.core_size()) =
      active_part(keyframe.active, difference(keyframe.state, keyframe.prior_at));
  for (std::size_t i = 0; i < keyframe.pieces.size(); ++i) {
    const auto piece = static_cast<Eigen::Index>(i);
    moved(keyframe.core_size() + piece) =
        graph.piece(keyframe.pieces[i]).value_m - keyframe.prior_pieces_at(piece);
  }
  const Eigen::Index first_piece =
      keyframe.pieces.empty() ? 0 : log.first.back() + keyframe.pieces.front();
  rows->add_quadratic(log.first[static_cast<std::size_t>(k)],
                      slope_of_difference(keyframe, keyframe.state, keyframe.prior_at), moved,
                      keyframe.prior_information, keyframe.prior_gradient, first_piece);
}

inline DenseLog dense_log(const LogGraph& graph) {
  DenseLog log;
  log.first.push_back(0);
  for (int k = 0; k < graph.size(); ++k)
    log.first.push_back(log.first.back() + graph.at(k).core_size());
  const auto pieces = static_cast<int>(graph.pieces().size());
  DenseRows rows(log.first.back() + pieces);
  for (int k = 0; k < graph.size(); ++k) {
    const LogKeyframe& keyframe = graph.at(k);
    if (keyframe.process.exists) add_process_rows(graph, k, log, &rows);
    if (keyframe.prior_information.size() > 0) add_prior_rows(graph, k, log, &rows);
    add_measurement_rows(graph, k, log, &rows);
  }
  for (int i = 0; i < pieces; ++i) add_step_of_piece(graph, i, log, &rows);
  rows.solve(&log);
  return log;
}

}  // namespace leonav::synthetic
