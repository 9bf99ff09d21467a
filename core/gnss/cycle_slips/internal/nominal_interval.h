// This header estimates the usual interval between the epochs of a stream.
#pragma once
#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/base/median.h"

namespace leonav {

// The nominal interval is the median of the last few, so that neither a missing nor a stray epoch
// counts.
class NominalInterval {
 public:
  void add(double interval_s) {
    if (intervals_s_.size() < intervals_s_.capacity()) {
      intervals_s_.push_back(interval_s);
    } else {
      intervals_s_[next_] = interval_s;
    }
    next_ = (next_ + 1) % intervals_s_.capacity();
    // Of two intervals the shorter one is taken, since the other may contain a missing epoch.
    nominal_s_ = intervals_s_.size() == 2 ? std::min(intervals_s_[0], intervals_s_[1])
                                          : median(intervals_s_);
  }
  double seconds() const { return nominal_s_; }  // 0: none observed

 private:
  boost::container::static_vector<double, 5> intervals_s_;
  std::size_t next_ = 0;
  double nominal_s_ = 0.0;
};

}  // namespace leonav
