// How far a recorded receiver's clock was off, told by its own measurements and the truth.
#pragma once
#include <map>
#include <string>

#include "core/time/gps_time.h"
#include "tools/motion/spline_motion.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/signals/receiver_clock.h"

namespace leonav::sim {

// Of each epoch by its stamp, what is common to all satellites. Codes: the median of (code - what
// the true position and the log's orbits predict) over one band of one system, the one most often
// there; where it is missing another one, less what it has beyond that on average. Good to a metre
// or two with a phone's codes, and 30 m (0.1 us) would do: a low satellite goes 0.7 mm in that
// time. Carriers have a clock of their own, as phones count them by another one: the sum of the
// medians of their steps beyond the ranges', or of the Dopplers where carriers are too few.
// Epochs with fewer than three satellites have none.
struct RecordedClock {
  std::map<GpsTime, ClockReading> readings;  // t: s from the motion's start
  long without = 0;                          // epochs within the motion that have none
  std::string other_prefix;                  // of epochs on channels of another name; empty: none
};

// Throws EventLogError as read_inputs() does.
RecordedClock recorded_clock(const std::string& log, const Scenario& scenario,
                             const SplineMotion& motion);

}  // namespace leonav::sim
