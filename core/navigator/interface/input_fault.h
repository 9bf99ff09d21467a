// InputFault states why an input message was not used.
#pragma once
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace leonav {

// The faults of inputs. On the wire: append only.
enum class InputFault : std::uint8_t {
  kNone = 0,
  kUndecodable = 1,       // the bytes are no message of the channel's type
  kUnknownSchema = 2,     // the message has another schema version
  kNotFinite = 3,         // a value is infinite or not a number
  kOutOfRange = 4,        // a value is outside its range, or an identifier is unknown
  kTimeBackwards = 5,     // the stamp is earlier than inputs before it
  kDuplicate = 6,         // the same input came before
  kTooMany = 7,           // it exceeds a fixed capacity
  kNotSane = 8,           // the values cannot be right, for instance a dead sensor
  kTooFarAhead = 9,       // the stamp is far later than all other inputs
  kOverlap = 10,          // the interval overlaps the previous one
  kTooOften = 11,         // more commands than anybody needs
  kUnauthenticated = 12,  // a command without a valid signature
};
inline constexpr std::size_t kInputFaultCount = 13;
// Returns the name of a fault as outputs show it, for instance "not_finite".
std::string_view to_string(InputFault fault);

}  // namespace leonav
