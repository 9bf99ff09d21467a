// The StationMonitor finds stations whose position moves within a stream of RTCM 3.
#pragma once
#include <cstdint>
#include <map>
#include <string>

#include "drivers/rtcm3/station_messages.h"

namespace leonav {

// A caster may hand out another base under the same number, as a network does when it chooses a
// nearer one: what is observed then is observed elsewhere.
class StationMonitor {
 public:
  // Less is a better survey of the same antenna.
  static constexpr double kLeastMove_m = 1.0;

  void take(const StationPosition& position);
  // How often stations have moved, and the last move; empty: none has.
  std::string text() const;
  // Returns a sentence once, after the first move; empty otherwise.
  std::string take_news();

 private:
  std::map<std::uint16_t, Eigen::Vector3d> positions_;  // p_e, m, of each station
  std::uint64_t moves_ = 0;
  std::uint16_t last_station_ = 0;
  double last_move_m_ = 0.0;
  bool is_told_ = false;
};

}  // namespace leonav
