// This unit schedules the group delays that come with the navigation files of a recording.
#pragma once
#include <vector>

#include "tools/import/internal/bias_source.h"

namespace leonav {

// Schedules delays, whose times are those at which they were sent, for a recording from `start` to
// `end` (unset: not known). Of each signal the newest one of the day before `start` arrives then,
// or without one the first that came within the day behind; the others when they were sent.
std::vector<ScheduledBiases> schedule_delays(std::vector<SignalBias> delays, GpsTime start,
                                             GpsTime end);

}  // namespace leonav
