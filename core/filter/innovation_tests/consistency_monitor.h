// Does the filter go on being as wrong as it says? Weights hide what a single epoch's test does not
// reject; a ratio that stays high tells it.
#pragma once

namespace leonav {

// Follows the mean of an epoch's consistency ratio (EkfUpdateResult: 1 when all is well) with an
// exponential window. The median of eight measurements scatters by 0.4 about 1, such a mean over
// thirty epochs by 0.05: 2 is not chance but sigmas half of what they should be, or a filter that
// follows something else than the vehicle.
class ConsistencyMonitor {
 public:
  // True when the mean has just become improbable; again only after it has recovered. NaN: nothing
  // to be told from this epoch.
  bool add(double ratio);
  double mean() const { return mean_; }

 private:
  static constexpr double kEpochs = 30.0;
  static constexpr double kInconsistent = 2.0;
  static constexpr double kRecovered = 1.5;

  double mean_ = 1.0;
  bool inconsistent_ = false;
};

}  // namespace leonav
