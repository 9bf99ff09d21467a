#include "tools/connect/formats/receivers/station_monitor.h"

#include <utility>

#include "tools/common/format.h"

namespace leonav {

void StationMonitor::take(const StationPosition& position) {
  // A base that does not know its position yet sends zeros.
  if (position.p_e.isZero()) return;
  const auto [known, is_new] = positions_.try_emplace(position.station, position.p_e);
  if (is_new) return;
  const double move_m = (position.p_e - known->second).norm();
  if (move_m <= kLeastMove_m) return;
  known->second = position.p_e;
  ++moves_;
  last_station_ = position.station;
  last_move_m_ = move_m;
}

std::string StationMonitor::text() const {
  if (moves_ == 0) return "";
  return leonav::format("its station %d has moved %llu times, the last by %.1f m",
                        int{last_station_}, static_cast<unsigned long long>(moves_), last_move_m_);
}

std::string StationMonitor::take_news() {
  if (moves_ == 0 || std::exchange(is_told_, true)) return "";
  return leonav::format(
      "its station %d has moved by %.1f m (messages 1005 and 1006): is it another one under the "
      "same number, or a receiver that moves and sends where it is? What comes now was observed "
      "there",
      int{last_station_}, last_move_m_);
}

}  // namespace leonav
