// OnOff is a Markov process in time that is either on or off.
#pragma once
#include <cstdint>

#include "tools/sim/motion/gaussian_generator.h"

namespace leonav::sim {

// Durations are exponential: on for `duration_s` in the mean, off for duration_s (1 - share) /
// share, so that it is on for `share` of the time. It begins in the stationary state.
class OnOff {
 public:
  OnOff(std::uint64_t key, double share, double duration_s);

  // Goes to time t >= 0, in order of time.
  void advance(double t);
  bool is_on() const { return on_; }
  // Number of the current episode of being on or off, from 1, and its begin.
  unsigned episode() const { return episode_; }
  double since_s() const { return since_s_; }

 private:
  double draw_end();

  GaussianGenerator random_;
  double mean_on_s_, mean_off_s_;
  bool on_;
  unsigned episode_ = 1;
  double since_s_ = 0.0, until_s_;
};

}  // namespace leonav::sim
