// WholeCycles learns how many of a receiver's carrier arcs differ by whole cycles.
#pragma once
#include <array>

namespace leonav {

// Two arcs of a satellite differ by whole cycles, unless the receiver begins its count anywhere, as
// some phones do, or one of the two came by a reflection. The share of those that do belongs to
// receiver and surroundings, which change as one drives. What each pair of arcs shows has the
// likelihood
//   share L + (1 - share),
// with L the likelihood of whole cycles over that of any length. The share's density, uniform at
// first, is multiplied by it (Bayes), on a grid, and forgets: each pair counts less by a factor e
// with every 200 that follow (exponential forgetting, a power prior).
class WholeCycles {
 public:
  WholeCycles() { weights_.fill(1.0); }

  // Takes the likelihood ratio L of one pair of arcs.
  void learn(double likelihood_ratio);
  // Returns the probability that a pair of arcs with this likelihood ratio differs by whole cycles,
  // where this share of all pairs does.
  static double probability(double likelihood_ratio, double share);
  // Returns the mean of the share.
  double share() const { return share_; }
  // Returns the number of pairs learned from.
  int pairs() const { return pairs_; }

 private:
  static constexpr int kSteps = 50;
  std::array<double, kSteps> weights_;
  double share_ = 0.5;
  int pairs_ = 0;
};

}  // namespace leonav
