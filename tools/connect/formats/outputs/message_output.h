// The MessageOutput publishes what streams decode, as one sender with one count for each channel.
#pragma once
#include <functional>
#include <optional>
#include <utility>

#include "core/base/gps_time.h"
#include "daemon/messages/encoding_sink.h"
#include "drivers/lcm/input_messages.h"
#include "tools/connect/formats/outputs/known_orbits.h"

namespace leonav {

class MessageOutput {
 public:
  // `target` must outlive this object.
  explicit MessageOutput(MessageTarget* target)
      : target_(target), own_(std::in_place), messages_(&*own_) {}
  // Encodes with the buffers of others, whose counts go on. Both must outlive this object.
  MessageOutput(MessageTarget* target, InputMessages* messages)
      : target_(target), messages_(messages) {}
  MessageOutput(const MessageOutput&) = delete;
  MessageOutput& operator=(const MessageOutput&) = delete;

  // The arguments are those of InputMessages::encode().
  template <typename... Values>
  void send(const Values&... values) {
    const InputMessage message = messages_->encode(values...);
    target_->take(message.channel, message.bytes);
    ++sent_;
  }
  // The time of the latest measurement sent, for the status.
  void note_time(GpsTime time) {
    if (time > last_time_) last_time_ = time;
    if (on_time_) on_time_(time);
  }
  // `listener` is told each of these times.
  void listen_to_time(std::function<void(GpsTime)> listener) { on_time_ = std::move(listener); }

  // Of which systems somebody is to be told that orbits are missing.
  void expect_orbits(const ExpectedOrbits& systems) { orbits_.expect(systems); }
  // Takes note of an ephemeris or a state that was sent, with its reference time.
  void note_orbit(SatelliteId satellite, GpsTime reference) { orbits_.note(satellite, reference); }

  const KnownOrbits& orbits() const { return orbits_; }
  GpsTime last_time() const { return last_time_; }
  std::uint64_t sent() const { return sent_; }

 private:
  MessageTarget* target_;
  std::optional<InputMessages> own_;
  InputMessages* messages_;
  KnownOrbits orbits_;
  GpsTime last_time_;
  std::uint64_t sent_ = 0;
  std::function<void(GpsTime)> on_time_;
};

}  // namespace leonav
