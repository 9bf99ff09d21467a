// SolverAgreement compares the minima that the smoother's chain and Ceres find of the same windows.
#pragma once
#include <Eigen/Core>

#include "core/smoother/ceres/ceres_solver.h"
#include "core/smoother/rts_solver.h"
#include "core/smoother/window.h"

namespace leonav {

// Both start from the window's estimates, displaced by a sigma of the newest keyframe to and fro,
// with the weights that it has. Where the chain cannot solve the window, Ceres has to fail too.
class SolverAgreement {
 public:
  struct Counts {
    long windows = 0;
    long not_given = 0;  // beyond these: with noise that a graph for Ceres has no term for
    long only_chain = 0, only_ceres = 0, neither = 0;  // found a minimum
    double most_cost = 0.0;        // largest difference of cost, as a share of it
    double most_sigmas = 0.0;      // and of a state, in sigmas of the newest keyframe
    double most_of_allowed = 0.0;  // the larger of both, as a share of what is allowed
  };

  // `capacity`: keyframes.
  SolverAgreement(const Eigen::Vector3d& lever_arm_b, int capacity);

  // Returns whether Ceres can be given the window, so that it counts.
  bool add(const Window& window);

  const Counts& counts() const { return counts_; }
  void print() const;
  // Throws std::runtime_error as compare_solvers() does.
  void require() const;

 private:
  bool iterate(Window* window);
  double cost_of(const Window& window) const;
  void compare(const Window& by_chain, const Window& by_ceres, const EkfCorrection& sigmas);

  Eigen::Vector3d lever_arm_b_;
  RtsSolver chain_;
  CeresSolver ceres_;
  WindowCorrections corrections_;
  Counts counts_;
};

}  // namespace leonav
