// Smoother estimates the last keyframes together and returns the state of the newest one.
//
// It minimizes the cost of core/smoother/window_solver.h over a sliding window: a factor graph of
// prior, process factors and measurements (Dellaert and Kaess, Factor Graphs for Robot Perception,
// 2017), with the oldest keyframe marginalized. Position and velocity in ECEF, SI units.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <limits>
#include <memory>

#include "core/filter/state/covariance_blocks.h"
#include "core/smoother/internal/descending_step.h"
#include "core/smoother/internal/divergence_test.h"
#include "core/smoother/internal/window_weights.h"
#include "core/smoother/repropagation.h"
#include "core/smoother/rts_solver.h"
#include "core/smoother/smoother_config.h"
#include "core/smoother/smoother_status.h"
#include "core/smoother/window.h"

namespace leonav {

// The oldest keyframe of a full window, from all of the window: a fixed lag behind the newest one.
struct LaggedState {
  bool valid = false;
  std::uint64_t index = 0;  // of its epoch
  bool has_attitude = false;
  NavState state;
  PoseCovariance covariance = PoseCovariance::Zero();
  double time_offset_s = 0.0;
};

// Result of one solve.
struct SmootherResult {
  SmootherStatus status = SmootherStatus::kNoFilter;
  int iterations = 0;
  bool converged = false;
  int shortened = 0;  // steps of which only a part was taken, or none, because the cost would rise
  bool left_to_chain = false;  // the minimizer has found no step, and the chain has taken one
  bool has_attitude = false;
  NavState state;  // at the newest keyframe
  InertialCovariance covariance = InertialCovariance::Zero();
  int used = 0;                    // measurements of the newest keyframe with a factor above zero
  double time_offset_s = 0.0;      // estimated: the state is this much later than its stamp
  AttitudeRandomWalk random_walk;  // of the window's attitude, from here on
  bool filter_is_younger = false;  // it has started over within the window, and knows less
  // It has been so for a while in which codes have fitted the window: the filter may take the
  // window's state.
  bool filter_may_follow = false;
  LaggedState lagged;
};

// Smoother works keyframe by keyframe: add(), solve(), then commit_or_roll_back().
//
// The last call states whether the result was in time. Without a minimizer it allocates when
// constructed, not after, and it never throws.
class Smoother {
 public:
  // `lever_arm_b`: m, from the IMU to the antenna, body axes. `minimizer` takes all steps of a
  // solve at once; nullptr: the chain takes them one by one. Where the minimizer finds none, the
  // chain does.
  Smoother(const SmootherConfig& config, const RobustConfig& robust,
           const Eigen::Vector3d& lever_arm_b, const ProcessPropagationConfig& repropagation,
           std::unique_ptr<WindowSolver> minimizer = nullptr);

  // Adds a keyframe. Where the filter has started over, the IMU connects it with the newest one;
  // one that cannot be connected starts a new window.
  void add(const KeyframeInput& input);
  // Iterates from the state that the last committed solve left, until a step is short. The chain
  // computes the weights of all measurements before every step, a minimizer once.
  SmootherResult solve(SolveBudget* budget);
  // Commits the last solve if its result was taken. Otherwise the window returns to its state
  // before solve(), so that later results do not depend on how many iterations were done.
  void commit_or_roll_back(bool taken);

  const Window& window() const { return window_; }
  // Returns how many process factors have been repropagated so far.
  std::uint64_t repropagations() const { return repropagator_.repropagations(); }

 private:
  // The part of a keyframe that a solve changes.
  struct Saved {
    FilterState state;
    boost::container::static_vector<double, kMaxMeasurements> factors;
    bool weights_decided = false;
  };
  bool fails_on_purpose(DrilledFailure failure) const;
  bool has_all_of_window(const KeyframeInput& input) const;
  bool append(const KeyframeInput& input);
  bool filter_is_younger() const { return restarted_.is_set(); }
  void save();
  void restore();
  void repropagate();
  void marginalize_and_drop_oldest();
  bool iterate(int iteration, SmootherResult* result);
  bool take_step(SmootherResult* result);
  bool minimize(SolveBudget* budget, SmootherResult* result);
  bool is_converged(double moved_m) const;
  double sigma_m() const { return std::min(filter_sigma_m_, window_sigma_m_); }
  WindowAgainstFilter against_filter(const Keyframe& newest) const;
  void finish(SmootherResult* result);
  void add_lagged(SmootherResult* result);

  SmootherConfig config_;
  RobustConfig robust_;
  Eigen::Vector3d lever_arm_b_;
  Window window_;
  WindowWeights weights_;
  RtsSolver rts_solver_;
  std::unique_ptr<WindowSolver> minimizer_;
  Repropagator repropagator_;
  DivergenceTest believed_;
  WindowCorrections corrections_;
  DescendingStep step_;
  std::unique_ptr<Saved[]> saved_;
  std::unique_ptr<WindowPrior> next_prior_;
  // The filter at the newest keyframe. Without an attitude its position is compared at the antenna.
  Eigen::Vector3d filter_position_e_ = Eigen::Vector3d::Zero();
  bool filter_has_attitude_ = false;
  GpsTime restarted_;  // when the filter has started over, while it knows less; otherwise unset
  // Solves in a row since then whose codes have fitted the window: taken ones, and with the last.
  int fitting_ = 0, fitting_with_last_ = 0;
  double filter_sigma_m_ = 0.0;
  // 1 sigma of the window's position at its newest keyframe (3D): by the last solve that was taken,
  // and by the last one. Infinite: the window has begun since.
  double window_sigma_m_ = std::numeric_limits<double>::infinity();
  double solved_sigma_m_ = std::numeric_limits<double>::infinity();
  bool solved_ = false;          // and neither committed nor rolled back
  bool failed_ = false;          // the window starts over with the next keyframe
  bool newest_follows_ = false;  // the newest keyframe follows the one before it
  bool window_lost_ = false;     // the window before the newest keyframe could not be kept
};

}  // namespace leonav
