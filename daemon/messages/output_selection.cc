#include "daemon/messages/output_selection.h"

#include "core/base/gps_time.h"
#include "drivers/lcm/wire.h"

namespace leonav {

bool OutputSelection::contains(Channel channel, ByteSpan bytes) {
  const bool thinned = outputs_ == RecordedOutputs::kThinned;
  switch (channel) {
    case Channel::kSolution: {
      if (outputs_ == RecordedOutputs::kAll) return true;
      if (!thinned || bytes.size() < wire::kTimeOffset + 8) return false;
      const auto second = wire::read_int64(bytes, wire::kTimeOffset) / kNanosecondsPerSecond;
      if (second == last_second_) return false;
      last_second_ = second;
      return true;
    }
    case Channel::kEpoch:
    case Channel::kConstraints:
    case Channel::kSmoothed:
      return outputs_ != RecordedOutputs::kNone;
    case Channel::kCommandNonce:
      return false;  // a replay needs none
    default:
      return true;
  }
}

}  // namespace leonav
