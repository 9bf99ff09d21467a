// ConsistencyMonitor detects that innovations are persistently larger than the filter's sigmas.
#pragma once

namespace leonav {

// It follows the mean of the consistency ratio (consistency_ratio(), 1 when all is well) over an
// exponential window of thirty epochs. The ratio of eight measurements scatters by 0.4 about 1,
// this mean by 0.05: a mean of 2 is no chance, but sigmas of half the true size, or a filter that
// follows something else than the vehicle. Single epochs below their test's limit do not reveal
// this.
class ConsistencyMonitor {
 public:
  // Adds an epoch's ratio; NaN is skipped. Returns true when the mean has just exceeded 2, and
  // again only after it has fallen below 1.5.
  bool add(double ratio);
  double mean() const { return mean_; }

 private:
  double mean_ = 1.0;
  bool inconsistent_ = false;
};

}  // namespace leonav
