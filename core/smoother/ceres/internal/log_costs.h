// This unit gives the terms of a LogGraph's cost to Ceres: priors, process factors, motion
// constraints, codes and Dopplers, carriers, joined arcs, and the steps of ambiguities.
#pragma once
#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "core/smoother/ceres/internal/log_unknowns.h"

namespace leonav {

// LogCost holds the residuals that depend on one keyframe's core states, or on those of two
// successive ones, and on pieces of ambiguities. It refers to graph and unknowns, which must
// outlive it.
class LogCost : public ceres::CostFunction {
 public:
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  const std::vector<int>& blocks() const { return blocks_; }
  bool usable() const { return usable_; }
  // Returns the sigma in the gain over that for the test, of a single measurement; 0: it is none.
  virtual double gain_to_test_sigma() const { return 0.0; }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const final;

 protected:
  LogCost(const LogGraph& graph, const LogUnknowns& unknowns, std::vector<int> keyframes,
          std::vector<int> pieces = {});

  // A trial point, and what is wanted of it.
  struct Evaluation {
    std::vector<CoreState> states;  // of the keyframes
    Eigen::VectorXd pieces;         // errors, m
    Eigen::VectorXd* residuals;
    // d residuals / d (change of the state), by keyframe; nullptr: not wanted.
    std::vector<Eigen::MatrixXd>* jacobians;
    Eigen::MatrixXd* of_pieces;  // a column per piece
  };
  virtual void evaluate(const Evaluation& at) const = 0;

  const LogGraph& graph_;
  std::vector<int> keyframes_;
  bool usable_ = true;

 private:
  const LogUnknowns& unknowns_;
  std::vector<int> pieces_;
  std::vector<int> blocks_;
  std::vector<std::vector<int>> slots_;  // by keyframe and active state: index among blocks_
};

// Appends all terms of the cost but the steps of ambiguities. Without `factors` all measurements
// have the factor one and a term each. Returns false if one cannot be used.
bool make_costs(const LogGraph& graph, const LogUnknowns& unknowns, bool factors,
                std::vector<std::unique_ptr<LogCost>>* costs);

// The step from one piece of an ambiguity to the next, or from its first guess.
class PieceCost final : public ceres::CostFunction {
 public:
  // `before` is nullptr where the piece does not go on from another.
  PieceCost(const AmbiguityPiece& piece, const AmbiguityPiece* before);
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const final;

 private:
  double shift_m_, weight_;
  bool follows_;
};

}  // namespace leonav
