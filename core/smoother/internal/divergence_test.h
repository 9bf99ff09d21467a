// DivergenceTest decides whether the window is still believed where it and the filter disagree.
#pragma once

namespace leonav {

// Window and filter at one keyframe.
struct WindowAgainstFilter {
  double apart_m = 0.0;         // between the two positions, 3D
  double window_sigma_m = 0.0;  // 1 sigma of the positions, 3D
  double filter_sigma_m = 0.0;
  bool filter_is_younger = false;  // it has started over within the window
  bool codes_fit_window = false;   // most codes of the keyframe fit the window's estimate, or none
  int codes = 0;                   // of the keyframe
};

// Two estimates from the same measurements differ by less than the less accurate one is wrong: the
// variance of their difference is P_filter - P_window where the window is efficient (Hausman,
// Econometrica 46(6), 1978). So the window is given up where they are farther apart than the sigmas
// of both together. A filter that has started over lacks measurements that the window has: their
// difference may then be three times the root of that variance. Beyond it the codes decide: the
// window is given up once they have contradicted it in ten solves in a row.
class DivergenceTest {
 public:
  // Returns whether the window is believed after a solve.
  bool operator()(const WindowAgainstFilter& at);
  // Call it once the last solve was taken; otherwise that solve counts for nothing.
  void commit() { contradictions_ = with_last_solve_; }
  // Call it for a new window.
  void reset() { contradictions_ = with_last_solve_ = 0; }

 private:
  int contradictions_ = 0;  // in a row
  int with_last_solve_ = 0;
};

}  // namespace leonav
