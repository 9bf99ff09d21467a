// Gauss-Newton steps of the window by its own structure: a chain in time.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <memory>

#include "core/smoother/linear_link.h"
#include "core/smoother/linearization.h"
#include "core/smoother/window_solver.h"

namespace leonav {

// Forward, what all keyframes up to one tell of it; backward, what those after it add (Rauch, Tung,
// Striebel 1965). With A_k the information of keyframe k from all up to k, H_k of its measurements:
//   P_k = F A_(k-1)^-1 F^T + N,  A_k = P_k^-1 + H_k.
// The noise N is added, never inverted: where a state hardly moves, eliminating keyframes from the
// normal equations would subtract W = N^-1 from itself and leave what is known of the state to
// rounding. Allocates when constructed, not after.
class ChainSolver final : public WindowSolver {
 public:
  explicit ChainSolver(int capacity);

  // One step, linearized at the keyframes' states.
  bool solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
             WindowCorrections* corrections) override;

  // The rest is of the last solve(), which must have succeeded, and of the states it was given.

  // Covariance of the newest keyframe's active states.
  void newest_covariance(EkfCovariance* covariance) const;
  // Sets KeyframeMeasurement::others_variance in the `count` newest keyframes.
  void find_others_variances(const Eigen::Vector3d& lever_arm_b, int count, Window* window) const;

 private:
  struct Block {
    EkfCovariance root;         // L with L L^T = A_k, lower
    EkfCorrection filtered;     // the keyframe's error by all up to it
    EkfCovariance spread;       // L_(k-1)^-1 F^T
    EkfCovariance predicted;    // P_k^-1
    EkfCorrection from_before;  // the error that the keyframes before predict
  };
  Block& block(int i) const { return blocks_[static_cast<std::size_t>(i)]; }
  bool predict(const Keyframe& before, const Keyframe& keyframe, int i);

  std::unique_ptr<Block[]> blocks_;
  int size_ = 0;
  std::unique_ptr<MeasurementInformation> information_;
  std::unique_ptr<LinearLink> link_;
};

// What the oldest keyframe, with its measurements, leaves behind about the next one when it goes:
// its mean and covariance, moved by the link. False: it has none that is finite.
bool marginalize_oldest(const Window& window, const Eigen::Vector3d& lever_arm_b,
                        WindowPrior* prior);

}  // namespace leonav
