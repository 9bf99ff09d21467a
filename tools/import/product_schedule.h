// This unit schedules the products of a recording at the times at which a live system would receive
// them.
#pragma once
#include <cstddef>
#include <vector>

#include "core/base/gps_time.h"
#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/orbits/ephemeris_store.h"

namespace leonav {

// An ephemeris with its time of arrival.
struct ScheduledEphemeris {
  GpsTime arrival;
  Ephemeris ephemeris;  // transmission_time is always set
};

// The schedule of all ephemerides, with counts of those left out.
struct EphemerisSchedule {
  std::vector<ScheduledEphemeris> items;  // in order of arrival
  long repeated = 0;                      // same satellite, message, toe and issue
  long expired = 0;                       // no longer valid at the start
  long superseded = 0;                    // more than two newer ones had arrived at the start
};

// Of what a satellite has sent so many of the newest serve.
inline constexpr std::size_t kIssuesInUse = 2;
// Elements of low orbits are useless after two hours, whatever `max_age_leo_s` of leonavd allows.
inline constexpr double kLongestLeoAge_s = 7200.0;

// Schedules every ephemeris at its transmission time, but not before `start`.
//
// Of those sent before `start`, the two newest of a satellite and message that are still valid are
// used. A satellite without any gets the first one that is valid at `start` though sent later: the
// file of a short recording holds only those sent during it, while the receiver had earlier ones.
EphemerisSchedule schedule_ephemerides(std::vector<Ephemeris> ephemerides, GpsTime start);

// Returns the transmission time, or an estimate if the file does not give it: GPS uploads begin two
// hours before toe (IS-GPS-200 20.3.4.4), Galileo and BeiDou at toe.
GpsTime transmission_time(const Ephemeris& ephemeris);

struct OrbitEpoch {
  GpsTime time;
  std::vector<PreciseState> states;
};

struct ScheduledOrbitEpoch {
  GpsTime arrival;
  OrbitEpoch epoch;
};

// Schedules a satellite's node at the time of the node `nodes_ahead` before it.
//
// Interpolation then always has nodes on both sides. No node arrives before `start`, and those that
// are `nodes_ahead` nodes or more before `start` are left out. Each satellite has its own nodes, so
// that products of different intervals can be mixed.
std::vector<ScheduledOrbitEpoch> schedule_orbits(std::vector<OrbitEpoch> epochs, GpsTime start,
                                                 int nodes_ahead);

// The orbit's polynomial needs seven nodes on each side (kPolynomialNodes); EphemerisStore holds
// kMaxOrbitNodes. Clocks of clock files are linear, and the next pair of nodes distinguishes a step
// from a new rate.
inline constexpr int kOrbitNodesAhead = 8;
inline constexpr int kClockNodesAhead = 3;

}  // namespace leonav
