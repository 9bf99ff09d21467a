// LogProcesses integrates the inertial process factors of a LogGraph from its own estimates, which
// makes them independent of how the filter got along.
#pragma once
#include "core/smoother/batch/log_graph.h"
#include "core/smoother/process_propagation.h"

namespace leonav {

// LogProcesses changes process factors and, where it gives a keyframe an attitude, its states.
class LogProcesses {
 public:
  explicit LogProcesses(const ProcessPropagationConfig& config)
      : config_(config), propagation_(config) {}

  // Gives an attitude to keyframes without one, by integrating the rates from the nearest one that
  // has it: before the filter's alignment backward, otherwise forward. Joins what the filter's
  // restarts have parted, with new clocks and ambiguities there. Integrates all factors between
  // keyframes with an attitude. Returns how many keyframes got an attitude and how many gaps were
  // joined.
  struct Extension {
    int attitudes = 0, joined = 0;
  };
  Extension extend(LogGraph* graph);
  // Repeats the integration of every factor whose first keyframe has moved away from the state at
  // which the factor was linearized. Returns the number of such factors.
  int reintegrate(LogGraph* graph);

 private:
  bool can_integrate(const LogKeyframe& before, const LogKeyframe& keyframe) const;
  Eigen::Quaterniond body_rotation(const LogKeyframe& keyframe, const NavState& start);
  void give_attitude(const LogKeyframe& from, const Eigen::Quaterniond& q_eb,
                     const Eigen::Vector3d& lever_arm_b, LogKeyframe* keyframe,
                     LogKeyframe* next) const;
  double configured_sigma(int state) const;
  void widen_prior(LogKeyframe* keyframe, const ActiveStates& had) const;
  void refit(const LogKeyframe& before, LogKeyframe* keyframe) const;
  void integrate(LogKeyframe* before, LogKeyframe* keyframe);

  ProcessPropagationConfig config_;
  ProcessPropagation propagation_;
};

}  // namespace leonav
