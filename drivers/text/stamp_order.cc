#include "drivers/text/stamp_order.h"

#include <algorithm>
#include <array>

namespace leonav {
namespace {

// Two stamps may have equally many stamps that can follow (at the end of a file: none). The first
// one is then wrong if it is ahead of the last good one by more than this.
constexpr double kLeap_s = 10.0;

}  // namespace

// Returns whether another start than the oldest stamp keeps more of the stamps.
bool StampWindow::is_contradicted() const {
  if (std::is_sorted(stamps_.begin(), stamps_.end())) return false;
  const GpsTime front = stamps_.front();
  const bool leaps = last_.is_set() && seconds_between(front, last_) > kLeap_s;
  // kept[i] is the number of stamps that can follow stamp i, itself included, counted from the
  // back.
  std::array<int, kStampsAhead + 1> kept{};
  int best_other = 0;
  for (std::size_t i = stamps_.size(); i-- > 0;) {
    if (last_.is_set() && stamps_[i] <= last_) continue;
    int behind = 0;
    for (std::size_t j = i + 1; j < stamps_.size(); ++j) {
      if (stamps_[j] > stamps_[i]) behind = std::max(behind, kept[j]);
    }
    kept[i] = behind + 1;
    if (i > 0 && stamps_[i] < front) best_other = std::max(best_other, kept[i]);
  }
  return best_other > kept[0] || (leaps && best_other == kept[0]);
}

bool StampWindow::take() {
  const GpsTime stamp = stamps_.front();
  const bool in_order = !(last_.is_set() && stamp <= last_) && !is_contradicted();
  stamps_.pop_front();
  if (in_order) last_ = stamp;
  return in_order;
}

std::vector<bool> stamps_in_order(std::span<const GpsTime> stamps) {
  std::vector<bool> in_order;
  in_order.reserve(stamps.size());
  StampWindow window;
  for (const GpsTime stamp : stamps) {
    window.push(stamp);
    if (window.is_full()) in_order.push_back(window.take());
  }
  while (!window.empty()) in_order.push_back(window.take());
  return in_order;
}

}  // namespace leonav
