// This unit encodes and decodes signed commands and the random numbers that they are signed with.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include "core/navigator/interface/input_fault.h"
#include "drivers/lcm/decode.h"

namespace leonav {

// A random number, by which a signed command serves once.
using CommandNonce = std::array<std::uint8_t, 16>;
// HMAC-SHA256 of a command.
using CommandMac = std::array<std::uint8_t, 32>;
inline constexpr std::size_t kCommandBytes = 8 + 8 + 8 + 4 + 1 + 8 + 8;  // of an encoded command_t
using CommandBytes = std::array<std::uint8_t, kCommandBytes>;

// Channel of signed commands, without prefix. It is none of `Channel`: for the engine and its
// journal a signed command that was taken is one of Channel::kCommand.
inline constexpr std::string_view kSignedCommandChannel = "SIGNED_COMMAND";

struct SignedCommand {
  std::uint64_t sequence = 0;  // of the sender
  CommandNonce nonce{};
  CommandBytes command{};
  CommandMac mac{};
};

// Both have a fixed size, so that nothing here allocates.
inline constexpr std::size_t kSignedCommandBytes = 8 + 8 + 8 + 4 + 16 + kCommandBytes + 32;
inline constexpr std::size_t kCommandNonceBytes = 8 + 8 + 8 + 4 + 16;

std::array<std::uint8_t, kSignedCommandBytes> encode_signed_command(const SignedCommand& command);
std::array<std::uint8_t, kCommandNonceBytes> encode_command_nonce(const CommandNonce& nonce,
                                                                  std::uint64_t sequence);

// kNone: `command` is filled; its signature has still to be checked.
InputFault decode_signed_command(ByteSpan bytes, SignedCommand* command);
// Returns nullopt where the message is damaged or has another schema.
std::optional<CommandNonce> decode_command_nonce(ByteSpan bytes);

}  // namespace leonav
