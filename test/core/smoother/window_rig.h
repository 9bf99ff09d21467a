// Windows of the tests: filled keyframe by keyframe, solved by whichever solver, and by dense least
// squares.
#pragma once
#include <Eigen/Cholesky>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "core/smoother/rts_solver.h"
#include "core/smoother/window.h"
#include "support/dense/dense_algebra.h"

namespace leonav::synthetic {

// Appends, after the oldest keyframe has gone if there is no place. False: a start anew.
inline bool feed(const KeyframeInput& input, const Eigen::Vector3d& lever_b, Window* window) {
  if (window->full()) {
    const auto prior = std::make_unique<WindowPrior>();
    if (!RtsSolver(2).marginalize_oldest(*window, lever_b, prior.get())) return false;
    window->drop_oldest(*prior);
  }
  if (window->size() > 0 && input.follows_previous && window->append(input)) return true;
  window->start(input);
  return false;
}

inline void apply(const WindowCorrections& corrections, Window* window) {
  for (int i = 0; i < window->size(); ++i) {
    Keyframe& keyframe = window->at(i);
    add(full_error(keyframe.active, corrections[static_cast<std::size_t>(i)]),
        keyframe.has_attitude, &keyframe.state);
  }
}

// Steps of `solver` until they have become nothing; false if one fails.
inline bool iterate(WindowSolver* solver, const Eigen::Vector3d& lever_b, int steps,
                    Window* window) {
  const auto corrections = std::make_unique<WindowCorrections>();
  for (int i = 0; i < steps; ++i) {
    if (!solver->solve(*window, lever_b, corrections.get())) return false;
    apply(*corrections, window);
  }
  return true;
}

// How an error of the estimate changes its difference from where a process_factor or prior was
// linearized.
inline Eigen::MatrixXd change_of_difference(const ActiveStates& active, const FilterState& estimate,
                                            const FilterState& linearized_at) {
  Eigen::MatrixXd J = Eigen::MatrixXd::Identity(active.size(), active.size());
  const AttitudeJacobian change = attitude_jacobian(active, estimate, linearized_at);
  if (change.index >= 0) J.block<3, 3>(change.index, change.index) = change.of_error;
  return J;
}

// A Gauss-Newton step of the whole window as one problem of whitened rows, by QR. The noise is
// whitened by its own root, not by that of its inverse.
struct DenseStep {
  Eigen::VectorXd correction;  // of all keyframes' active states, oldest first
  Eigen::MatrixXd covariance;
  double cost = 0.0;  // half the sum of the whitened residuals' squares, but for a constant
  std::vector<Eigen::Index> first;  // of each keyframe
};

// Motion constraints: V D V^T is their information, D^(1/2) V^T its root, row by row. What the
// information does not see it does not move, and has no row.
inline void set_information_rows(const ProcessFactor& factor, const Keyframe& before,
                                 Eigen::Ref<Eigen::MatrixXd> J, Eigen::Ref<Eigen::VectorXd> r) {
  const Eigen::Index core = before.active.core_size();
  const Eigen::MatrixXd information = factor.information.topLeftCorner(core, core);
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(core);
  for (Eigen::Index i = 0; i < core; ++i)
    if (information(i, i) > 0.0) scale(i) = 1.0 / std::sqrt(information(i, i));
  const dense::SymmetricParts parts =
      dense::symmetric_parts(scale.asDiagonal() * information * scale.asDiagonal());
  const EkfCorrection moved = active_part(before.active, difference(before.state, factor.from));
  for (Eigen::Index i = 0; i < core; ++i) {
    const double size = parts.eigenvalues(i);
    if (size < 1e-12) continue;
    const Eigen::VectorXd direction = parts.eigenvectors.col(i);
    const Eigen::VectorXd root = std::sqrt(size) * direction.cwiseQuotient(scale);
    J.row(i) = root.transpose() *
               change_of_difference(before.active, before.state, factor.from).topRows(core);
    r(i) = direction.dot(scale.cwiseProduct(factor.gradient.head(core))) / std::sqrt(size) -
           root.dot(moved.head(core));
  }
}

inline DenseStep dense_step(const Window& window, const Eigen::Vector3d& lever_b) {
  DenseStep step;
  Eigen::Index states = 0, rows = 0;
  for (int i = 0; i < window.size(); ++i) {
    step.first.push_back(states);
    states += window.at(i).active.size();
    rows += window.at(i).active.size() +
            static_cast<Eigen::Index>(window.at(i).measurements.size() +
                                      (i > 0 ? window.at(i).process_factor.joins.size() : 0));
    if (i > 0 && window.at(i).process_factor.has_information)
      rows += window.at(i - 1).active.core_size();
  }
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows, states);
  Eigen::VectorXd r = Eigen::VectorXd::Zero(rows);
  Eigen::Index row = 0;
  for (int k = 0; k < window.size(); ++k) {
    const Keyframe& keyframe = window.at(k);
    const Eigen::Index own = step.first[static_cast<std::size_t>(k)];
    const Eigen::Index n = keyframe.active.size();
    if (k == 0) {
      // The information's root R, with R^T R; its gradient is R^T of what is whitened.
      const Eigen::MatrixXd R =
          Eigen::MatrixXd(Eigen::LLT<Eigen::MatrixXd>(window.prior().information).matrixU());
      const EkfCorrection moved =
          active_part(keyframe.active, difference(keyframe.state, window.prior().at));
      J.block(row, own, n, n) =
          R * change_of_difference(keyframe.active, keyframe.state, window.prior().at);
      r.segment(row, n) =
          R.transpose().triangularView<Eigen::Lower>().solve(window.prior().gradient) - R * moved;
    } else {
      const Keyframe& before = window.at(k - 1);
      const Eigen::MatrixXd root = dense::whitening(keyframe.process_factor.noise);
      J.block(row, own, n, n) =
          root * change_of_difference(keyframe.active, keyframe.state, keyframe.process_factor.to);
      J.block(row, step.first[static_cast<std::size_t>(k) - 1], n, before.active.size()) =
          -root * keyframe.process_factor.F *
          change_of_difference(before.active, before.state, keyframe.process_factor.from);
      r.segment(row, n) = -root * process_error(before, keyframe);
    }
    row += n;
    if (k > 0) {
      const Keyframe& before = window.at(k - 1);
      const Eigen::Index ambiguities =
          step.first[static_cast<std::size_t>(k) - 1] + before.active.core_size();
      const auto value_m = [&](int i) {
        return before.state.ambiguities[static_cast<std::size_t>(i)].value_m;
      };
      for (const ArcJoin& join : keyframe.process_factor.joins) {
        const double weight = 1.0 / std::sqrt(join.variance);
        J(row, ambiguities + join.to) = weight;
        J(row, ambiguities + join.from) = -weight;
        r(row++) = weight * (join.difference_m - (value_m(join.to) - value_m(join.from)));
      }
      if (keyframe.process_factor.has_information) {
        const Eigen::Index core = before.active.core_size();
        set_information_rows(
            keyframe.process_factor, before,
            J.block(row, step.first[static_cast<std::size_t>(k) - 1], core, before.active.size()),
            r.segment(row, core));
        row += core;
      }
    }
    const AntennaMotion antenna = antenna_of(keyframe, lever_b);
    for (const KeyframeMeasurement& m : keyframe.measurements) {
      const double weight = std::sqrt(m.factor / m.gain_variance);
      const LinearMeasurement linear = linearize(m, keyframe, antenna);
      for (Eigen::Index i = 0; i < keyframe.active.core_size(); ++i)
        J(row, own + i) =
            weight * row_of(linear, keyframe.active.core[static_cast<std::size_t>(i)]);
      if (m.ambiguity >= 0) J(row, own + keyframe.active.core_size() + m.ambiguity) = weight;
      r(row++) = weight * linear.residual;
    }
  }
  step.cost = 0.5 * r.squaredNorm();
  dense::LeastSquares fit = dense::least_squares(J, r);
  step.correction = std::move(fit.solution);
  step.covariance = std::move(fit.covariance);
  return step;
}

// Of what two solutions of the same window are apart at most, in sigmas of `dense`.
inline double apart_in_sigmas(const WindowCorrections& corrections, const DenseStep& dense) {
  double most = 0.0;
  for (std::size_t k = 0; k < dense.first.size(); ++k)
    for (Eigen::Index i = 0; i < corrections[k].size(); ++i) {
      const Eigen::Index j = dense.first[k] + i;
      most = std::max(most, std::abs(corrections[k](i) - dense.correction(j)) /
                                std::sqrt(dense.covariance(j, j)));
    }
  return most;
}

}  // namespace leonav::synthetic
