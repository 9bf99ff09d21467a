// FileBiases holds the biases of files in messages of one validity each, and lets those of a
// satellite give way to a correction service's.
#pragma once
#include <cstddef>
#include <map>
#include <span>
#include <vector>

#include "core/gnss/propagation/signal_bias_store.h"

namespace leonav {

// Biases hold against the clocks of one provider, and a service's belong to the clocks that it
// sends. Those of files are published for its satellites neither beside nor after them, until its
// own have ended: the last published one of a signal counts, and a pair of signals could be of two
// providers.
class FileBiases {
 public:
  // Few enough for a datagram that the network does not split.
  static constexpr std::size_t kOfMessage = 40;

  struct Message {
    std::size_t index, count;  // in the order of validity
    GpsTime from, until;       // when it may be published; unset: always, for good
  };

  explicit FileBiases(std::vector<SignalBias> biases);

  std::span<const Message> messages() const { return messages_; }

  // Returns what of message `i` is to be published at `now`, and takes it as published: all of it,
  // or with `missing_only` what has not been, or has been ended since.
  std::vector<SignalBias> take(std::size_t i, GpsTime now, bool missing_only);
  // Whether all of message `i` has been published and not been ended.
  bool is_whole(std::size_t i) const;

  // Takes biases of a service that are about to be published. Returns ends at `now` of what has
  // been published for its satellites, to be published before.
  std::vector<SignalBias> yield_to(std::span<const SignalBias> of_service, GpsTime now);

 private:
  struct One {
    SignalBias bias;
    bool is_published = false;
  };

  bool yields(SatelliteId satellite, GpsTime now) const;

  std::vector<One> biases_;  // by validity
  std::vector<Message> messages_;
  std::map<SatelliteId, GpsTime> of_service_;  // until when a satellite's biases are a service's
};

}  // namespace leonav
