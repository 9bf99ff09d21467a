// RtsSolver takes Gauss-Newton steps of the window by a forward and a backward pass over the chain
// of keyframes.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <memory>

#include "core/smoother/linear_process_factor.h"
#include "core/smoother/linearization.h"
#include "core/smoother/window_solver.h"

namespace leonav {

// The forward pass collects the information of all keyframes up to one, the backward pass adds that
// of the later ones (Rauch, Tung, Striebel, AIAA J. 3(8), 1965).
//
// With A_k the information about keyframe k from all keyframes up to k, and H_k that of its
// measurements:
//   P_k = F A_(k-1)^-1 F^T + N,  A_k = P_k^-1 + H_k.
// The noise N is added, never inverted. Eliminating keyframes from the normal equations would
// subtract W = N^-1 from itself where a state hardly moves, and rounding would destroy the
// information about that state. Allocates when constructed, not after. Cost: O(keyframes n^3).
class RtsSolver final : public WindowSolver {
 public:
  // `capacity` is the largest number of keyframes.
  explicit RtsSolver(int capacity);

  // Computes one step, linearized at the keyframes' states.
  bool solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
             WindowCorrections* corrections) override;

  // Returns the covariance of the newest keyframe's active states from the last solve(), which must
  // have succeeded, at the states that were given to it.
  void newest_covariance(EkfCovariance* covariance) const;

 private:
  struct Block {
    EkfCovariance root;             // L with L L^T = A_k, lower
    EkfCorrection filtered;         // the keyframe's error from all keyframes up to it
    EkfCovariance spread;           // L_(k-1)^-1 F^T
    EkfCovariance predicted;        // P_k^-1
    EkfCorrection predicted_error;  // predicted from the keyframes before
  };
  Block& block(int i) const { return blocks_[static_cast<std::size_t>(i)]; }
  bool predict(const Keyframe& before, const Keyframe& keyframe, int i);

  std::unique_ptr<Block[]> blocks_;
  int size_ = 0;
  std::unique_ptr<MeasurementInformation> information_;
  std::unique_ptr<LinearProcessFactor> process_factor_;
};

// Marginalizes the oldest keyframe: computes the prior that it leaves on the next one.
//
// The mean and covariance after its measurements are propagated by the process factor. Returns
// false if they are not finite. Precondition: at least two keyframes.
bool marginalize_oldest(const Window& window, const Eigen::Vector3d& lever_arm_b,
                        WindowPrior* prior);

}  // namespace leonav
