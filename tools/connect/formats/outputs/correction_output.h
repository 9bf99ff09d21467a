// The CorrectionOutput publishes what the corrections of one stream make of the broadcast messages
// of all streams.
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>

#include "tools/connect/formats/outputs/message_output.h"
#include "tools/import/correction_services.h"

namespace leonav {

// What the streams share: ephemerides often come from another stream than corrections, and of
// several services one corrects a system.
struct SharedCorrections {
  // `message_output` must outlive this object. `listener` is told whenever the service of a system
  // changes; it may be empty.
  SharedCorrections(const CorrectionOptions& options, const ServiceChoiceOptions& choice,
                    MessageOutput* message_output,
                    std::function<void(const ServiceChange&)> listener = {})
      : services(options, choice), output(message_output), on_change(std::move(listener)) {}

  CorrectionServices services;
  MessageOutput* output;
  std::function<void(const ServiceChange&)> on_change;
  std::function<void(std::span<const SignalBias>)> on_biases;  // of all that are published
};

// Each stream has one. CORRECTED_STATES come with every message that has clocks, of its satellites,
// and BIASES with every message of biases, where the stream's service is the one in use.
class CorrectionOutput {
 public:
  // Streams are preferred in the order of these calls. `shared` must outlive this object.
  CorrectionOutput(const std::string& stream, SharedCorrections* shared)
      : shared_(shared), stream_(shared->services.add_stream(stream)) {}

  void add(const Ephemeris& ephemeris) { shared_->services.add(ephemeris); }
  // Takes a message that came at `now`, GPS time. Returns the number of messages with states that
  // were published, or left out because another service is in use.
  int take(const SsrMessage& message, GpsTime now);
  // Why corrections came and none could be used, with the remedy for the most frequent reason.
  std::string why_none() const;
  // What came, in a few words; empty while nothing has come.
  std::string detail() const;

 private:
  SharedCorrections* shared_;
  std::size_t stream_;
  std::size_t last_usable_ = 0, last_satellites_ = 0;  // of the last message that has clocks
};

}  // namespace leonav
