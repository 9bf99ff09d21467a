// When a live system would have received the products that a recording holds as files.
#pragma once
#include <vector>

#include "core/gnss/ephemeris.h"
#include "core/gnss/satellite_catalog.h"
#include "core/time/gps_time.h"

namespace leonav {

struct ScheduledEphemeris {
  GpsTime arrival;
  Ephemeris ephemeris;  // transmission_time is always set
};

struct EphemerisSchedule {
  std::vector<ScheduledEphemeris> items;  // in order of arrival
  long repeated = 0;                      // same satellite, message, toe and issue
  long expired = 0;                       // no longer valid at the start
  long superseded = 0;                    // more than two newer ones were there at the start
};

// Every ephemeris arrives when it was sent, but not before `start`: of those sent before, the two
// newest of a satellite and message that are still valid. A satellite that has none by then gets
// the first that is valid at `start` though sent later: the file of a short recording holds only
// what came during it, while the receiver knew the satellites from before.
EphemerisSchedule schedule_ephemerides(std::vector<Ephemeris> ephemerides, GpsTime start);

// When it was sent, or an estimate where the file does not tell: GPS uploads begin two hours before
// toe (IS-GPS-200 20.3.4.4), Galileo and BeiDou begin at toe.
GpsTime transmission_time(const Ephemeris& ephemeris);

struct OrbitEpoch {
  GpsTime time;
  std::vector<PreciseState> states;
};

struct ScheduledOrbitEpoch {
  GpsTime arrival;
  OrbitEpoch epoch;
};

// A satellite's node arrives at the time of the node `nodes_ahead` before it, so that interpolation
// always has nodes on both sides; not before `start`, and none that lies `nodes_ahead` nodes or
// more before it. Each satellite goes by its own nodes, so that products of different intervals
// mix.
std::vector<ScheduledOrbitEpoch> schedule_orbits(std::vector<OrbitEpoch> epochs, GpsTime start,
                                                 int nodes_ahead);

// The orbit's polynomial wants seven nodes on each side (kPolynomialNodes); the catalog keeps
// kMaxOrbitNodes. Clocks of clock files are linear, and the next pair tells a step from a new rate.
inline constexpr int kOrbitNodesAhead = 8;
inline constexpr int kClockNodesAhead = 3;

}  // namespace leonav
