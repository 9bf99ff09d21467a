// Which time stamps of a file are in order: one that is wrong must cost itself and nothing else.
#pragma once
#include <cstddef>
#include <deque>
#include <span>
#include <vector>

#include "core/time/gps_time.h"

namespace leonav {

// Decides about the stamps of a stream one by one, knowing the next kStampsAhead. A stamp is in
// order if it is later than the last one that was, and if no later start would keep more of those
// behind it in increasing order: a stamp that leaps ahead is refused by its successors, not they by
// it. So up to kStampsAhead / 2 wrong stamps in a row are told from right ones, also the first.
inline constexpr std::size_t kStampsAhead = 31;

class StampWindow {
 public:
  void push(GpsTime stamp) { stamps_.push_back(stamp); }
  bool empty() const { return stamps_.empty(); }
  // All is known that take() needs. At the end of the stream it may be called without.
  bool is_full() const { return stamps_.size() > kStampsAhead; }
  // Takes the oldest stamp out; true: it is in order.
  bool take();

 private:
  bool is_contradicted() const;

  std::deque<GpsTime> stamps_;
  GpsTime last_;  // in order
};

// The same for stamps that are all there: true where one is in order.
std::vector<bool> stamps_in_order(std::span<const GpsTime> stamps);

}  // namespace leonav
