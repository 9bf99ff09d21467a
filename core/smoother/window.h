// Window holds the keyframes of the smoother, their process factors, and the prior from those that
// were marginalized.
#pragma once
#include <Eigen/Core>
#include <memory>

#include "core/smoother/keyframe.h"

namespace leonav {

// The information from all marginalized keyframes about the window's first one.
//
// Its cost is 0.5 (x - at)^T information (x - at) - gradient^T (x - at), in active states. It was
// linearized once, at that keyframe's estimate when the keyframe before it was marginalized
// (first-estimate Jacobians).
struct WindowPrior {
  FilterState at;
  EkfCovariance information;
  EkfCorrection gradient;
};

// Window is a ring of keyframes in time order. Allocates when constructed, not after.
class Window {
 public:
  // `capacity`: keyframes.
  explicit Window(int capacity);
  Window(const Window& other);
  Window& operator=(const Window&) = delete;
  Window(Window&&) = default;

  void clear() { size_ = 0; }
  int size() const { return size_; }
  int capacity() const { return capacity_; }
  bool full() const { return size_ == capacity_; }
  Keyframe& at(int i) { return slots_[slot(i)]; }  // 0: the oldest
  const Keyframe& at(int i) const { return slots_[slot(i)]; }
  Keyframe& newest() { return at(size_ - 1); }
  const Keyframe& newest() const { return at(size_ - 1); }
  const WindowPrior& prior() const { return prior_; }

  // Starts a new window with the filter's state and covariance, which contain the input's
  // measurements. Returns false if the covariance is not positive definite.
  bool start(const KeyframeInput& input);
  // Appends a keyframe at the state that the newest one predicts. Returns false if its process does
  // not begin at the newest keyframe or is not finite. Precondition: not full().
  bool append(const KeyframeInput& input);
  // Appends a keyframe whose filter has started over, or has no attitude where the window has one:
  // nothing of the vehicle's motion leads from the newest one to it until Repropagator::integrate()
  // has added the inertial part of the process. Clocks, delays and ambiguities go on as the
  // filter's or, where it has started over, begin anew. Preconditions: not full(), can_bridge().
  void append_apart(const KeyframeInput& input);
  // Removes the oldest keyframe; `prior` is the information it leaves about the next.
  void drop_oldest(const WindowPrior& prior);

 private:
  std::size_t slot(int i) const {
    return (first_ + static_cast<std::size_t>(i)) % static_cast<std::size_t>(capacity_);
  }

  int capacity_;
  std::unique_ptr<Keyframe[]> slots_;
  std::size_t first_ = 0;
  int size_ = 0;
  WindowPrior prior_;
};

// Returns whether the IMU's samples can connect the newest keyframe with one whose filter has
// started over or has no attitude: the newest one has an attitude, none has come from outside
// since, and the samples are at hand.
bool can_bridge(const Window& window, const KeyframeInput& input);

// Returns the state of `keyframe` that the process factor predicts from `before`.
FilterState predicted_state(const Keyframe& before, const Keyframe& keyframe);
// Returns (x - to) - F (x_before - from), in active states: at the keyframes' states, or at others.
EkfCorrection process_error(const Keyframe& before, const Keyframe& keyframe);
EkfCorrection process_error(const ActiveStates& active_before, const FilterState& before,
                            const Keyframe& keyframe, const FilterState& state);

}  // namespace leonav
