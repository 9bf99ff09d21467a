// RtsSolver takes Gauss-Newton steps of the window by a forward and a backward pass over the chain
// of keyframes.
#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <boost/container/static_vector.hpp>
#include <memory>

#include "core/smoother/linear_process_factor.h"
#include "core/smoother/linearization.h"
#include "core/smoother/window_solver.h"

namespace leonav {

// Position, velocity and attitude, the first states in the order of ekf_index.
inline constexpr int kPoseStates = 9;
using PoseCovariance = Eigen::Matrix<double, kPoseStates, kPoseStates>;

// The forward pass collects the information of all keyframes up to one, the backward pass adds that
// of the later ones (Rauch, Tung, Striebel, AIAA J. 3(8), 1965). The states of a keyframe are split
// into those x that the process moves, and the ambiguities b that it carries over, which are a
// border of the chain (arrowhead). With information A about both,
//   A_xx = L L^T,  Y = L^-1 A_xb:  b has the information S = A_bb - Y^T Y, whatever x does,
//   and given b, x has the mean L^-T (y - Y b) and the covariance A_xx^-1,
// so that a process factor works on x alone:
//   X = L^-1 F^T,  P = X^T X + N,  W = P^-1,  Z = X^T Y
//   A'_xx = W,  A'_xb = W Z,  A'_bb = S + Z^T W Z
// The random walk of ambiguities, with variances Q, then takes some of that information away:
//   T T^T = A'_bb + Q^-1,  V = T^-1 A'_b:  A'' = A' - V^T V
// The noise N is added, never inverted. Eliminating keyframes from the normal equations would
// subtract N^-1 from itself where a state hardly moves, and rounding would destroy the information
// about that state. Allocates when constructed, not after. Cost: O(keyframes (m + b)^3), for m
// moved states and b ambiguities half of what it is without the split.
class RtsSolver final : public WindowSolver {
 public:
  // `capacity` is the largest number of keyframes.
  explicit RtsSolver(int capacity);
  ~RtsSolver() override;

  // Computes one step, linearized at the keyframes' states.
  bool solve(const Window& window, const Eigen::Vector3d& lever_arm_b,
             WindowCorrections* corrections) override;

  // Returns the covariance of the newest keyframe's active states from the last solve(), which must
  // have succeeded, at the states that were given to it.
  void newest_covariance(EkfCovariance* covariance) const;

  // Returns the covariance of the oldest keyframe's position, velocity and attitude, from all of
  // the window, after the last solve() of it.
  void oldest_covariance(const Window& window, PoseCovariance* covariance);

  // Marginalizes the oldest keyframe: computes the prior that it leaves on the next one, at the
  // keyframes' states. Returns false if that is not finite. Precondition: at least two keyframes.
  bool marginalize_oldest(const Window& window, const Eigen::Vector3d& lever_arm_b,
                          WindowPrior* prior);

 private:
  struct Step;
  template <typename Rhs>
  struct Reduced;
  void collect(const Window& window, const Eigen::Vector3d& lever_arm_b, int i);
  bool move_on(const Window& window, int i, Step* step);
  bool walk(const EkfCovariance& noise, Step* step);
  void lead_gradient(Step* step);
  template <typename Rhs>
  void forward(const Step& step, const EkfCorrection& offset, Rhs* rhs,
               Reduced<Rhs>* reduced) const;
  template <typename Rhs>
  void backward(const Step& step, const Reduced<Rhs>& reduced, Rhs* solution) const;
  template <typename Rhs>
  void solve_newest(Rhs* rhs) const;

  std::unique_ptr<Step[]> steps_;  // step i leads from keyframe i to the next
  int size_ = 0;
  // Information about the keyframe at hand, and at the end the Cholesky root of the newest one's.
  EkfCovariance information_;
  EkfCorrection gradient_;
  std::unique_ptr<MeasurementInformation> measurements_;
  std::unique_ptr<LinearProcessFactor> process_factor_;
};

}  // namespace leonav
