// leave_to_process() is for what a thread goes on using that the disk holds, when its owner ends.
#pragma once
#include <atomic>

namespace leonav {

// Keeps `state` for as long as the process lives, and within reach, so that it is no leak.
template <typename State>
void leave_to_process(State* state) {
  static std::atomic<State*> last{nullptr};
  state->left_before = last.exchange(state);
}

}  // namespace leonav
