// OrbitTable holds a satellite's true orbit as dense nodes.
#pragma once
#include <Eigen/Core>
#include <utility>
#include <vector>

#include "tools/sim/sky/orbit_integrator.h"

namespace leonav::sim {

// Interpolation is quintic Hermite (position, velocity, acceleration at both ends) in the inertial
// frame of OrbitState. The error is below h^6 / 46080 times the sixth derivative: 0.1 um for LEO
// nodes every 30 s, 0.02 um for GNSS nodes every 120 s.
class OrbitTable {
 public:
  // `states` are nodes every `step_s` from `first_s` on (seconds from the scenario's start).
  OrbitTable(double first_s, double step_s, const std::vector<OrbitState>& states);
  struct Node {
    Eigen::Vector3d p, v, a;
  };
  OrbitTable(double first_s, double step_s, std::vector<Node> nodes)
      : first_s_(first_s), step_s_(step_s), nodes_(std::move(nodes)) {}

  OrbitState at(double t) const;  // beyond the nodes: the last interval's polynomial

 private:
  double first_s_, step_s_;
  std::vector<Node> nodes_;
};

}  // namespace leonav::sim
