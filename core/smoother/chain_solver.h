// Gauss-Newton steps of the window by its own structure: block-tridiagonal in time.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <memory>

#include "core/smoother/linearization.h"
#include "core/smoother/window_solver.h"

namespace leonav {

// Cholesky factors of the normal equations, keyframe by keyframe: with S_k what is left of a
// keyframe's block once those before it are eliminated,
//   S_k = L_k L_k^T,  B_(k+1) = H_(k+1,k) L_k^-T,  S_(k+1) = H_(k+1,k+1) - B_(k+1) B_(k+1)^T.
// Allocates when constructed, not after.
class ChainSolver final : public WindowSolver {
 public:
  explicit ChainSolver(int capacity);

  // One step, linearized at the keyframes' states.
  bool solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
             WindowCorrections* corrections) override;

  // Covariance of the newest keyframe's active states, of the last solve(), which must have
  // succeeded, at the states it was given.
  void newest_covariance(EkfCovariance* covariance) const;

 private:
  struct Block {
    EkfCovariance root;    // L_k, lower
    EkfCovariance below;   // B_k: against the keyframe before
    EkfCorrection solved;  // L_k^-1 times the gradient
  };
  Block& block(int i) const { return blocks_[static_cast<std::size_t>(i)]; }

  std::unique_ptr<Block[]> blocks_;
  int size_ = 0;
  std::unique_ptr<MeasurementInformation> information_;
};

// What the oldest keyframe, with its measurements, leaves behind about the next one when it goes:
// its mean and covariance, moved by the link. False: it has none that is finite.
bool marginalize_oldest(const Window& window, const Eigen::Vector3d& lever_arm_b,
                        WindowPrior* prior);

}  // namespace leonav
