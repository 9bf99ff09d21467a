// This unit determines a recorded receiver's clock offset from its measurements and the truth.
#pragma once
#include <map>
#include <string>

#include "core/base/gps_time.h"
#include "tools/sim/motion/spline_motion.h"
#include "tools/sim/scenario/scenario.h"
#include "tools/sim/signals/receiver_clock.h"

namespace leonav::sim {

// The offsets, per epoch by its stamp, are what is common to all satellites.
//
// Codes: the median of (code minus prediction from true position and the log's orbits) over one
// band of one system, the one most often measured; where it is missing, another one minus its mean
// difference. The accuracy is a metre or two with a phone's codes, and 30 m (0.1 us) would suffice:
// a low satellite moves 0.7 mm in that time. Carriers have a separate clock, because phones count
// them by another one: the sum of the medians of their steps beyond the ranges', or of the Dopplers
// where there are too few carriers. Epochs with fewer than three satellites have no reading.
struct RecordedClock {
  std::map<GpsTime, ClockReading> readings;  // t: s from the motion's start
  long without = 0;                          // epochs within the motion without a reading
  std::string other_prefix;  // of epochs on channels with another prefix; empty: none
};

// Reads the log. Throws EventLogError as read_inputs() does.
RecordedClock recorded_clock(const std::string& log, const Scenario& scenario,
                             const SplineMotion& motion);

}  // namespace leonav::sim
