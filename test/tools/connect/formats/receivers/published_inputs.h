// What tests of receivers' formats share: messages packed number by number, and what is published
// of them.
#pragma once
#include <bit>
#include <cstdint>
#include <vector>

#include "daemon/messages/encoding_sink.h"
#include "drivers/lcm/decode.h"
#include "support/catch.h"

namespace leonav::test {

// Numbers one after the other, least significant byte first.
struct Packed {
  Packed& add(std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
    return *this;
  }
  Packed& real(double value) { return add(std::bit_cast<std::uint64_t>(value), 8); }
  Packed& single(float value) { return add(std::bit_cast<std::uint32_t>(value), 4); }
  std::vector<std::uint8_t> bytes;
};

// Takes epochs and inertial samples, and nothing else.
struct PublishedInputs : MessageTarget {
  void take(Channel channel, ByteSpan bytes) override {
    if (channel == Channel::kGnssEpoch) {
      REQUIRE(Decoder().decode(bytes, &epochs.emplace_back()).fault == InputFault::kNone);
    } else {
      REQUIRE(channel == Channel::kImu);
      REQUIRE(Decoder().decode(bytes, &samples.emplace_back()).fault == InputFault::kNone);
    }
  }
  std::vector<RawEpoch> epochs;
  std::vector<ImuSample> samples;
};

}  // namespace leonav::test
