// This unit runs the decoders that LCM generates on bytes from outside.
#pragma once
#include <cstdint>
#include <span>

#include "core/navigator/interface/input_fault.h"
#include "drivers/lcm/wire.h"

namespace leonav {

// Runs the generated decoder and checks that it used the whole message and that the schema is
// `schema`. Precondition: counts have been checked, where the message has any.
template <typename T>
InputFault read_message(std::span<const std::uint8_t> bytes, std::int32_t schema, T* message) {
  if (bytes.size() > wire::kMaxMessageBytes) return InputFault::kTooMany;
  const int size = static_cast<int>(bytes.size());
  if (message->decode(bytes.data(), 0, size) != size) return InputFault::kUndecodable;
  return message->schema == schema ? InputFault::kNone : InputFault::kUnknownSchema;
}

}  // namespace leonav
