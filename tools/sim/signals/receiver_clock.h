// ReceiverClock gives the time of the receiver's clock, and the offsets of the systems' times.
#pragma once
#include <array>
#include <vector>

#include "core/gnss/signals/satellite.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/sky/clock_table.h"

namespace leonav::sim {

// The clock at one of its own stamps; offsets are "clock minus GPS time".
struct ClockReading {
  double t = 0.0;                        // GPS time, s from the start
  double code_s = 0.0, carrier_s = 0.0;  // offset in codes, and in carriers
  double drift = 0.0;
};

// ReceiverClock is read in order of time.
class ReceiverClock {
 public:
  explicit ReceiverClock(const Scenario& scenario);

  // Returns the reading at which the clock shows `t_tag`. If it has left its limit, it is first set
  // back by whole milliseconds. Stamps are in order of time.
  ClockReading read(double t_tag);

  // Returns one system's time and delay relative to GPS, in metres of range.
  ClockTable::Value time_base_m(System system, double t) const;

 private:
  ReceiverClockConfig config_;
  ClockTable oscillator_;
  double steps_s_ = 0.0;                // sum so far
  std::vector<ClockTable> time_bases_;  // by System; their "seconds" are metres
};

}  // namespace leonav::sim
