// The OutputSelection decides which outputs a journal is to hold (journal.outputs).
#pragma once
#include <cstdint>

#include "drivers/lcm/channels.h"
#include "drivers/lcm/encode.h"
#include "drivers/lcm/journal_marks.h"

namespace leonav {

class OutputSelection {
 public:
  explicit OutputSelection(RecordedOutputs outputs) : outputs_(outputs) {}

  // To be called for each message, in the order of publication.
  bool contains(Channel channel, ByteSpan bytes);
  RecordedOutputs outputs() const { return outputs_; }

 private:
  RecordedOutputs outputs_;
  std::int64_t last_second_ = -1;  // of data time, of the last SOLUTION contained
};

}  // namespace leonav
