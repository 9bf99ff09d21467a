// The CorrectionOutput publishes what a correction service's messages make of the broadcast ones.
#pragma once
#include <cstdint>
#include <string>

#include "drivers/ssr/correction_store.h"
#include "tools/connect/formats/message_output.h"

namespace leonav {

// One serves all streams, because ephemerides often come from another stream than corrections:
// CORRECTED_STATES with every message that has clocks, of its satellites, and BIASES with every
// message of biases.
class CorrectionOutput {
 public:
  // `output` must outlive this object.
  CorrectionOutput(const CorrectionOptions& options, MessageOutput* output)
      : store_(options), output_(output) {}

  void add(const Ephemeris& ephemeris) { store_.add(ephemeris); }
  // Takes a message that came at `now`, GPS time. Returns the number of messages with states
  // that were published.
  int take(const SsrMessage& message, GpsTime now);
  // What came, in a few words; empty while nothing has come.
  std::string detail() const;

 private:
  CorrectionStore store_;
  MessageOutput* output_;
  std::size_t last_states_ = 0, last_satellites_ = 0;  // of the last message that has clocks
};

}  // namespace leonav
