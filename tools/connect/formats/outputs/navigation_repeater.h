// The NavigationRepeater sends what a receiver took from navigation messages again, for a service
// that starts later or has lost it.
#pragma once
#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"
#include "core/gnss/propagation/signal_bias_store.h"
#include "tools/connect/formats/outputs/message_output.h"

namespace leonav {

// A receiver's ephemeris is decoded once per issue, which may serve for hours, and so are the
// coefficients of the ionosphere and the group delays; LCM keeps nothing and may lose it.
class NavigationRepeater {
 public:
  // Group delays are sent for so long after they were received, an ephemeris as long as leonavd
  // uses it (EphemerisConfig::max_age_s). The ionosphere has no such limit: its coefficients change
  // every few days. What is too old is kept, for an epoch's time may be wrong; newer contents take
  // its place.
  static constexpr double kMaxDelayAge_s = 4 * 3600.0;
  // At each epoch: all at once could find no room in the receiving socket. Those that wait longest
  // come first.
  static constexpr std::size_t kMostAtOnce = 4;

  // `interval_s`: from one time that something is sent to the next; 0: never again. `output` must
  // outlive this object.
  NavigationRepeater(double interval_s, MessageOutput* output)
      : interval_s_(interval_s), output_(output) {}

  // Each takes what was sent at `now`. Of the group delays the satellite's other ones are kept.
  void remember(const Ephemeris& ephemeris, GpsTime now);
  void remember(const KlobucharModel& model, GpsTime now);
  void remember(const std::vector<SignalBias>& of_satellite, GpsTime now);
  // To be called at every epoch: sends those that are due. Returns their number.
  int repeat(GpsTime now);

 private:
  using Content = std::variant<Ephemeris, KlobucharModel, std::vector<SignalBias>>;
  struct Key {
    std::size_t kind = 0;  // index in Content
    SatelliteId satellite = {};
    NavigationMessage message = {};
    friend constexpr auto operator<=>(const Key&, const Key&) = default;
  };
  struct Sent {
    Content content;
    GpsTime last;
  };
  void send(const Content& content, GpsTime now);

  double interval_s_;
  MessageOutput* output_;
  std::map<Key, Sent> sent_;
};

}  // namespace leonav
