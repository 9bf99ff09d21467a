// The three terms of the window's cost (core/smoother/window_solver.h) as Ceres takes them.
#pragma once
#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

#include "core/ceres/window_unknowns.h"

namespace leonav {

// Residuals of one keyframe or of two that follow each other, with their exact Jacobians. Borrows
// window and unknowns' layout.
class WindowCost : public ceres::CostFunction {
 public:
  const std::vector<int>& blocks() const { return blocks_; }
  bool usable() const { return usable_; }
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const final;

 protected:
  // `keyframes`: those that it is about.
  WindowCost(const Window& window, const WindowUnknowns& unknowns, std::vector<int> keyframes);

  struct At {
    FilterState state;
    EkfCorrection error;  // of the window's estimate
  };
  // Residuals and, one per keyframe, d residuals / d its error, both of the sizes they must have.
  virtual void evaluate(const std::vector<At>& at, Eigen::VectorXd* residuals,
                        std::vector<Eigen::MatrixXd>* jacobians) const = 0;

  const Window& window_;
  std::vector<int> keyframes_;
  bool usable_ = true;

 private:
  void scatter(const Eigen::MatrixXd& of_error, const WindowUnknowns::Places& places,
               double** jacobians) const;

  const WindowUnknowns& unknowns_;
  std::vector<int> blocks_;
  std::vector<int> slot_;  // of a block among blocks_; -1: not in it
};

class PriorCost final : public WindowCost {
 public:
  PriorCost(const Window& window, const WindowUnknowns& unknowns);

 private:
  void evaluate(const std::vector<At>& at, Eigen::VectorXd* residuals,
                std::vector<Eigen::MatrixXd>* jacobians) const override;

  Eigen::MatrixXd root_;   // U with U^T U the information
  Eigen::VectorXd drawn_;  // U^-T gradient
};

// Of the states that the process moves.
class LinkCost final : public WindowCost {
 public:
  // The link that ends at keyframe k.
  LinkCost(const Window& window, const WindowUnknowns& unknowns, int k);

 private:
  void evaluate(const std::vector<At>& at, Eigen::VectorXd* residuals,
                std::vector<Eigen::MatrixXd>* jacobians) const override;

  Eigen::MatrixXd root_;  // R with R^T R the inverse of the noise, moved rows only
};

// What constraints on the motion in the link that ends at keyframe k tell of the one before.
class InformationCost final : public WindowCost {
 public:
  InformationCost(const Window& window, const WindowUnknowns& unknowns, int k);

 private:
  void evaluate(const std::vector<At>& at, Eigen::VectorXd* residuals,
                std::vector<Eigen::MatrixXd>* jacobians) const override;

  const KeyframeLink& link_;
  Eigen::MatrixXd root_;   // R with R^T R the information; as many rows as that has rank
  Eigen::VectorXd drawn_;  // R^-T gradient
};

class MeasurementsCost final : public WindowCost {
 public:
  MeasurementsCost(const Window& window, const WindowUnknowns& unknowns, int k,
                   const Eigen::Vector3d& lever_arm_b);

 private:
  void evaluate(const std::vector<At>& at, Eigen::VectorXd* residuals,
                std::vector<Eigen::MatrixXd>* jacobians) const override;

  Eigen::Vector3d lever_arm_b_;
  std::vector<const KeyframeMeasurement*> used_;
};

}  // namespace leonav
