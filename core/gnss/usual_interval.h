// How far apart a stream's epochs usually are.
#pragma once
#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cstddef>

#include "core/median.h"

namespace leonav {

// The median of the last few intervals: neither a missing epoch nor a stray one counts.
class UsualInterval {
 public:
  void add(double interval_s) {
    if (intervals_s_.size() < intervals_s_.capacity()) {
      intervals_s_.push_back(interval_s);
    } else {
      intervals_s_[next_] = interval_s;
    }
    next_ = (next_ + 1) % intervals_s_.capacity();
    // Of two, the shorter: the other may have a missing epoch.
    usual_s_ = intervals_s_.size() == 2 ? std::min(intervals_s_[0], intervals_s_[1])
                                        : median(intervals_s_);
  }
  double seconds() const { return usual_s_; }  // 0: none seen

 private:
  boost::container::static_vector<double, 5> intervals_s_;
  std::size_t next_ = 0;
  double usual_s_ = 0.0;
};

}  // namespace leonav
