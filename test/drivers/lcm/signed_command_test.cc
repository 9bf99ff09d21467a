// Signed commands and their random numbers through bytes and back.
#include "drivers/lcm/signed_command.h"

#include <algorithm>
#include <vector>

#include "drivers/lcm/encode.h"
#include "drivers/lcm/wire.h"
#include "support/catch.h"

namespace {

using namespace leonav;

template <std::size_t size>
std::array<std::uint8_t, size> counted_from(std::uint8_t first) {
  std::array<std::uint8_t, size> bytes;
  for (std::uint8_t& byte : bytes) byte = first++;
  return bytes;
}

SignedCommand signed_command() {
  return {77, counted_from<16>(10), counted_from<kCommandBytes>(40), counted_from<32>(200)};
}

InputFault fault_of(ByteSpan bytes) {
  SignedCommand command;
  return decode_signed_command(bytes, &command);
}

}  // namespace

TEST_CASE("a signed command comes back, and a damaged one is refused", "[signed_command]") {
  const SignedCommand sent = signed_command();
  auto bytes = encode_signed_command(sent);
  SignedCommand received;
  REQUIRE(decode_signed_command(bytes, &received) == InputFault::kNone);
  CHECK(received.sequence == 77);
  CHECK(received.nonce == sent.nonce);
  CHECK(received.command == sent.command);
  CHECK(received.mac == sent.mac);

  for (std::size_t length = 0; length < bytes.size(); ++length)
    CHECK(fault_of(ByteSpan(bytes).first(length)) == InputFault::kUndecodable);
  const std::vector<std::uint8_t> junk(bytes.size() + 1, 0xAA);
  CHECK(fault_of(junk) == InputFault::kUndecodable);
  CHECK(fault_of(ByteSpan(junk).first(bytes.size())) == InputFault::kUndecodable);
  bytes[wire::kSchemaOffset + 3] = 2;
  CHECK(fault_of(bytes) == InputFault::kUnknownSchema);
}

TEST_CASE("the number for the next command comes back, and a damaged one is none",
          "[signed_command]") {
  const auto nonce = counted_from<16>(100);
  auto bytes = encode_command_nonce(nonce, 3);
  REQUIRE(decode_command_nonce(bytes).has_value());
  CHECK(*decode_command_nonce(bytes) == nonce);
  CHECK(!decode_command_nonce(ByteSpan(bytes).first(bytes.size() - 1)));
  CHECK(!decode_command_nonce(encode_signed_command(signed_command())));
  bytes[wire::kSchemaOffset + 3] = 2;
  CHECK(!decode_command_nonce(bytes));
}

TEST_CASE("an encoded command has the size that a signed one holds", "[signed_command]") {
  Encoder encoder;
  const ByteSpan bytes = encoder.encode({CommandKind::kSetHeading, 1.0, 0.1}, GpsTime(), 5);
  CHECK(bytes.size() == kCommandBytes);
}
