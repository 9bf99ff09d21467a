// What the receiver's clock shows, and how the systems' times stand against it.
#pragma once
#include <array>
#include <vector>

#include "core/gnss/satellite.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/sky/clock_table.h"

namespace leonav::sim {

// The clock at one of its own stamps; offsets are "clock minus GPS time".
struct ClockReading {
  double t = 0.0;                        // GPS time, s from the start
  double code_s = 0.0, carrier_s = 0.0;  // offset that codes, and that carriers, are measured by
  double drift = 0.0;
};

class ReceiverClock {
 public:
  explicit ReceiverClock(const Scenario& scenario);

  // When it shows `t_tag`. In order of time: where it has strayed beyond the limit it is set back
  // by whole milliseconds first.
  ClockReading read(double t_tag);

  // One system's time and delay against GPS, in metres of range.
  ClockTable::Value time_base_m(System system, double t) const;

 private:
  ReceiverClockConfig config_;
  ClockTable oscillator_;
  double steps_s_ = 0.0;                // so far
  std::vector<ClockTable> time_bases_;  // by System; "seconds" are metres
};

}  // namespace leonav::sim
