// This unit finds the time stamps of a file that are in order, so that a wrong stamp excludes only
// itself.
#pragma once
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "core/base/gps_time.h"

namespace leonav {

// The window decides about the stamps of a stream one by one, from the next kStampsAhead. A stamp
// is in order if it is later than the last one that was, and if no later start would keep more of
// the following stamps in increasing order. A stamp that leaps ahead is therefore refused by its
// successors and does not refuse them. Up to kStampsAhead / 2 wrong stamps in a row are recognized,
// also at the start of the stream.
inline constexpr std::size_t kStampsAhead = 31;

class StampWindow {
 public:
  void push(GpsTime stamp) { stamps_.push_back(stamp); }
  bool empty() const { return stamps_.empty(); }
  // Returns whether take() has all the stamps that it needs. At the end of the stream take() may be
  // called without them.
  bool is_full() const { return stamps_.size() > kStampsAhead; }
  // Removes the oldest stamp; returns whether it is in order.
  bool take();

 private:
  bool is_contradicted() const;

  std::deque<GpsTime> stamps_;
  GpsTime last_;  // the last stamp in order
};

// Decides the same for a complete list of stamps: true where one is in order.
std::vector<bool> stamps_in_order(std::span<const GpsTime> stamps);

}  // namespace leonav
