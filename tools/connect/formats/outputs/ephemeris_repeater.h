// The EphemerisRepeater sends ephemerides again, for a service that starts later or has lost one.
#pragma once
#include <map>
#include <utility>

#include "core/gnss/orbits/ephemeris.h"
#include "tools/connect/formats/outputs/message_output.h"

namespace leonav {

// A receiver's ephemeris is decoded once per issue, which may serve for hours; LCM keeps nothing
// and may lose it.
class EphemerisRepeater {
 public:
  static constexpr double kMaxAge_s = 4 * 3600.0;  // against its reference time; then it is dropped
  // At each epoch: all at once could find no room in the receiving socket.
  static constexpr int kMostAtOnce = 4;

  // `interval_s`: from one time that an ephemeris is sent to the next; 0: never again. `output`
  // must outlive this object.
  EphemerisRepeater(double interval_s, MessageOutput* output)
      : interval_s_(interval_s), output_(output) {}

  // Takes one that was sent at `now`.
  void remember(const Ephemeris& ephemeris, GpsTime now);
  // To be called at every epoch: sends those that are due. Returns their number.
  int repeat(GpsTime now);

 private:
  struct Sent {
    Ephemeris ephemeris;
    GpsTime last;
  };

  double interval_s_;
  MessageOutput* output_;
  std::map<std::pair<SatelliteId, NavigationMessage>, Sent> sent_;
};

}  // namespace leonav
