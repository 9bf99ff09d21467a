// The sliding-window smoother: keyframes in, the newest one's state out.
#pragma once
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <cstdint>
#include <memory>

#include "core/smoother/chain_solver.h"
#include "core/smoother/relink.h"
#include "core/smoother/smoother_config.h"
#include "core/smoother/smoother_status.h"
#include "core/smoother/window.h"
#include "core/smoother/window_weights.h"

namespace leonav {

// Asked before every iteration but the first of a solve.
class SolveBudget {
 public:
  virtual ~SolveBudget() = default;
  virtual bool may_iterate(int iterations_done) = 0;
};

struct SmootherResult {
  SmootherStatus status = SmootherStatus::kNoFilter;
  int iterations = 0;
  bool converged = false;
  bool has_attitude = false;
  NavState state;  // at the newest keyframe
  Eigen::Matrix<double, ekf_index::kInsSize, ekf_index::kInsSize> covariance =
      Eigen::Matrix<double, ekf_index::kInsSize, ekf_index::kInsSize>::Zero();
  int used = 0;                // measurements of the newest keyframe with a factor above zero
  double time_offset_s = 0.0;  // estimated: the state is of so much later than its stamp
};

// For every keyframe: add(), solve(), and settle() once it is known whether the result was taken.
// Allocates when constructed, not after; never throws.
class Smoother {
 public:
  Smoother(const SmootherConfig& config, const RobustConfig& robust,
           const Eigen::Vector3d& lever_arm_b, const RelinkConfig& relink);

  // A keyframe that does not follow the newest one starts a window of its own.
  void add(const KeyframeInput& input);
  // Iterates from where the last solve that was taken has left the window; the weights of all its
  // measurements are decided anew at every iteration.
  SmootherResult solve(SolveBudget* budget);
  // Not taken: the window is as it was before solve(), so that what follows does not depend on how
  // far that came.
  void settle(bool taken);

  const Window& window() const { return window_; }
  std::uint64_t relinked() const { return relinker_.relinked(); }  // links, so far

 private:
  // What a solve changes of a keyframe.
  struct Saved {
    FilterState state;
    boost::container::static_vector<double, kMaxMeasurements> factors;
    bool judged = false;
  };
  void save();
  void restore();
  void leave_oldest();
  bool iterate(int iteration, double* moved_sigmas, double* reweighed);
  void finish(SmootherResult* result);

  SmootherConfig config_;
  RobustConfig robust_;
  Eigen::Vector3d lever_arm_b_;
  Window window_;
  WindowWeights weights_;
  ChainSolver chain_;
  Relinker relinker_;
  WindowCorrections corrections_;
  std::unique_ptr<Saved[]> saved_;
  std::unique_ptr<WindowPrior> next_prior_;
  NavState filter_state_;  // at the newest keyframe
  double filter_sigma_m_ = 0.0;
  bool solved_ = false;  // and not settled
  bool failed_ = false;  // it starts over with the next keyframe
  bool linked_ = false;  // the newest keyframe follows the one before
  bool lost_ = false;    // the window before the newest keyframe could not be kept
};

}  // namespace leonav
