#include "daemon/messages/output_groups.h"

#include "drivers/lcm/wire.h"

namespace leonav {

std::optional<std::size_t> output_group(Channel channel, ByteSpan bytes) {
  switch (channel) {
    case Channel::kSolution:
      return 0;
    case Channel::kDecision: {
      const bool has_subject = bytes.size() > wire::kDecisionMailboxOffset;
      const bool is_keyframe =
          has_subject && bytes[wire::kDecisionMailboxOffset] ==
                             static_cast<std::uint8_t>(Decision::Subject::kKeyframe);
      return is_keyframe ? 8 : 1;
    }
    case Channel::kSmoother:
      return 7;
    case Channel::kSmoothed:
      return 9;
    case Channel::kEpoch:
    case Channel::kConstraints:  // of one epoch, behind it
      return 2;
    case Channel::kEvent: {
      // A damaged one is compared with the sequencer's: it differs from any that is regenerated.
      const bool has_stage = bytes.size() > wire::kEventStageOffset;
      const unsigned stage = has_stage ? bytes[wire::kEventStageOffset] : 0U;
      return 3 + (stage < 4 ? stage : 0U);
    }
    default:
      return std::nullopt;
  }
}

}  // namespace leonav
