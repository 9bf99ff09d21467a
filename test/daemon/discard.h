// A target of messages that nobody reads.
#pragma once
#include "daemon/messages/encoding_sink.h"

namespace leonav::test {

struct Discard final : MessageTarget {
  void take(Channel, ByteSpan) override {}
};

}  // namespace leonav::test
