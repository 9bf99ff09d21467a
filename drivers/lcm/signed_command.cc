#include "drivers/lcm/signed_command.h"

#include <algorithm>
#include <iterator>
#include <leonav/command_nonce_t.hpp>
#include <leonav/signed_command_t.hpp>

#include "drivers/lcm/internal/message_bytes.h"
#include "drivers/lcm/internal/read_message.h"
#include "drivers/lcm/wire.h"

namespace leonav {
std::array<std::uint8_t, kSignedCommandBytes> encode_signed_command(const SignedCommand& command) {
  signed_command_t message{};
  message.sequence = static_cast<std::int64_t>(command.sequence);
  message.schema = wire::kSchema;
  std::copy(command.nonce.begin(), command.nonce.end(), message.nonce);
  std::copy(command.command.begin(), command.command.end(), message.command);
  std::copy(command.mac.begin(), command.mac.end(), message.mac);
  return bytes_of<kSignedCommandBytes>(message);
}

std::array<std::uint8_t, kCommandNonceBytes> encode_command_nonce(const CommandNonce& nonce,
                                                                  std::uint64_t sequence) {
  command_nonce_t message{};
  message.sequence = static_cast<std::int64_t>(sequence);
  message.schema = wire::kSchema;
  std::copy(nonce.begin(), nonce.end(), message.nonce);
  return bytes_of<kCommandNonceBytes>(message);
}

InputFault decode_signed_command(ByteSpan bytes, SignedCommand* command) {
  signed_command_t message{};
  const InputFault fault = read_message(bytes, wire::kSchema, &message);
  if (fault != InputFault::kNone) return fault;
  command->sequence = static_cast<std::uint64_t>(std::max<std::int64_t>(message.sequence, 0));
  std::copy(std::begin(message.nonce), std::end(message.nonce), command->nonce.begin());
  std::copy(std::begin(message.command), std::end(message.command), command->command.begin());
  std::copy(std::begin(message.mac), std::end(message.mac), command->mac.begin());
  return InputFault::kNone;
}

std::optional<CommandNonce> decode_command_nonce(ByteSpan bytes) {
  command_nonce_t message{};
  if (read_message(bytes, wire::kSchema, &message) != InputFault::kNone) return std::nullopt;
  CommandNonce nonce;
  std::copy(std::begin(message.nonce), std::end(message.nonce), nonce.begin());
  return nonce;
}

}  // namespace leonav
