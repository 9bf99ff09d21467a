// This unit gives the terms of the window's cost (core/smoother/window_solver.h) to Ceres: prior,
// process factors, measurements.
#pragma once
#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

#include "core/smoother/ceres/internal/window_unknowns.h"

namespace leonav {

// WindowCost holds the residuals of one keyframe, or of two successive ones, with their exact
// Jacobians. It refers to the window and to the layout of the unknowns, which must outlive it.
class WindowCost : public ceres::CostFunction {
 public:
  const std::vector<int>& blocks() const { return blocks_; }
  bool usable() const { return usable_; }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const final;

 protected:
  // `keyframes` are the indices of those that the residuals depend on.
  WindowCost(const Window& window, const WindowUnknowns& unknowns, std::vector<int> keyframes);

  // A keyframe at a trial point of the optimization.
  struct LinearizedKeyframe {
    FilterState state;
    EkfCorrection error;  // from the window's estimate to `state`
  };
  // Computes the residuals and, for every keyframe, d residuals / d its error. Both outputs have
  // the right sizes on entry.
  virtual void evaluate(const std::vector<LinearizedKeyframe>& at, Eigen::VectorXd* residuals,
                        std::vector<Eigen::MatrixXd>* jacobians) const = 0;

  const Window& window_;
  std::vector<int> keyframes_;
  bool usable_ = true;

 private:
  void scatter(const Eigen::MatrixXd& of_error, const WindowUnknowns::BlockEntries& entries,
               double** jacobians) const;

  const WindowUnknowns& unknowns_;
  std::vector<int> blocks_;
  std::vector<int> slot_;  // index of a block among blocks_; -1: not there
};

// The prior of the window, on its oldest keyframe.
class PriorCost final : public WindowCost {
 public:
  PriorCost(const Window& window, const WindowUnknowns& unknowns);

 private:
  void evaluate(const std::vector<LinearizedKeyframe>& at, Eigen::VectorXd* residuals,
                std::vector<Eigen::MatrixXd>* jacobians) const override;

  Eigen::MatrixXd root_;               // U with U^T U = information
  Eigen::VectorXd whitened_gradient_;  // U^-T gradient
};

// The process factor between two keyframes, for the states that the process changes.
class ProcessCost final : public WindowCost {
 public:
  // Takes the process factor that ends at keyframe k.
  ProcessCost(const Window& window, const WindowUnknowns& unknowns, int k);

 private:
  void evaluate(const std::vector<LinearizedKeyframe>& at, Eigen::VectorXd* residuals,
                std::vector<Eigen::MatrixXd>* jacobians) const override;

  Eigen::MatrixXd root_;  // R with R^T R = N^-1, columns of changed states only
};

// The information that motion constraints between keyframes k-1 and k give about keyframe k-1, in
// addition to the process factor.
class InformationCost final : public WindowCost {
 public:
  InformationCost(const Window& window, const WindowUnknowns& unknowns, int k);

 private:
  void evaluate(const std::vector<LinearizedKeyframe>& at, Eigen::VectorXd* residuals,
                std::vector<Eigen::MatrixXd>* jacobians) const override;

  const ProcessFactor& process_factor_;
  Eigen::MatrixXd root_;  // R with R^T R = information, of as many rows as that has rank
  Eigen::VectorXd whitened_gradient_;  // R^-T gradient
};

// The measurements of one keyframe with a factor above zero: residual times sqrt(factor /
// variance).
class MeasurementsCost final : public WindowCost {
 public:
  MeasurementsCost(const Window& window, const WindowUnknowns& unknowns, int k,
                   const Eigen::Vector3d& lever_arm_b);

 private:
  void evaluate(const std::vector<LinearizedKeyframe>& at, Eigen::VectorXd* residuals,
                std::vector<Eigen::MatrixXd>* jacobians) const override;

  Eigen::Vector3d lever_arm_b_;
  std::vector<const KeyframeMeasurement*> used_;
};

}  // namespace leonav
