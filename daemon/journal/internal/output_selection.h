// The OutputSelection decides which messages a journal holds (journal.outputs).
#pragma once
#include <cstdint>

#include "daemon/config/daemon_config.h"
#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"

namespace leonav {

class OutputSelection {
 public:
  explicit OutputSelection(JournalOutputs outputs) : outputs_(outputs) {}

  // To be called for each message, in the order of publication.
  bool contains(Channel channel, ByteSpan bytes);

 private:
  JournalOutputs outputs_;
  std::int64_t last_second_ = -1;  // of data time, of the last SOLUTION contained
};

}  // namespace leonav
