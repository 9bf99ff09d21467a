// CodeCombinationMonitor decides whether codes of two frequencies are combined.
#pragma once
#include "core/filter/error_model/learned_errors.h"
#include "core/gnss/measurement/gnss_config.h"

namespace leonav {

// The ionosphere-free pair multiplies the noise and the reflections of its codes by 2.6 to 3.5. A
// single frequency has them once, and what the model of the ionosphere leaves. While carriers keep
// the position from epoch to epoch, noise averages and the pair is better in the end. Otherwise the
// errors of one epoch count. Noise averages over the n satellites that have a pair, what the
// ionosphere leaves is common to them (CodeVariances; s: learned factor on a satellite's sigma):
//   pair: 1 / sum 1/(s^2 pair_noise),   single: 1 / sum 1/(s^2 single_noise) + c ionosphere
// The logarithm of the ratio is averaged over some epochs, and the choice changes only where the
// other one is clearly better.
class CodeCombinationMonitor {
 public:
  explicit CodeCombinationMonitor(CodeCombination configured) : configured_(configured) {}

  // Adds the measurements of an epoch. `carriers_keep_position`: as Ekf::carriers_keep_position().
  void add(const MeasurementEpoch& epoch, const LearnedErrors& errors, bool carriers_keep_position);
  // Returns the combination for the next epoch, never kAutomatic.
  CodeCombination combination() const;

 private:
  CodeCombination configured_;
  bool single_ = false;
  double log_ratio_ = 0.0;  // variance with pairs over that with single frequencies
  GpsTime last_time_;
};

}  // namespace leonav
