// The keyframes of the smoother, their links, and what is left of those that have gone.
#pragma once
#include <Eigen/Core>
#include <memory>

#include "core/smoother/keyframe.h"

namespace leonav {

// What all that has left the window says of its first keyframe: 0.5 (x - at)^T information (x - at)
// - gradient^T (x - at), in active states. Linearized once, where that keyframe was when the one
// before it left (first-estimate Jacobians).
struct WindowPrior {
  FilterState at;
  EkfCovariance information;
  EkfCorrection gradient;
};

// Allocates when constructed, not after.
class Window {
 public:
  // `capacity`: keyframes.
  explicit Window(int capacity);

  void clear() { size_ = 0; }
  int size() const { return size_; }
  int capacity() const { return capacity_; }
  bool full() const { return size_ == capacity_; }
  Keyframe& at(int i) { return slots_[slot(i)]; }  // 0: the oldest
  const Keyframe& at(int i) const { return slots_[slot(i)]; }
  Keyframe& newest() { return at(size_ - 1); }
  const Keyframe& newest() const { return at(size_ - 1); }
  const WindowPrior& prior() const { return prior_; }

  // The only keyframe: the filter's state and covariance, which hold its measurements. False: the
  // covariance is none.
  bool start(const KeyframeInput& input);
  // One more, at the state that the newest one predicts. Not when full. False: its process
  // does not begin there or is not finite.
  bool append(const KeyframeInput& input);
  // The oldest leaves; `prior` is what it leaves behind.
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

// Where the keyframe before predicts this one to be.
FilterState predicted_state(const Keyframe& before, const Keyframe& keyframe);
// (x - to) - F (x_before - from), in active states.
EkfCorrection link_error(const Keyframe& before, const Keyframe& keyframe);

}  // namespace leonav
