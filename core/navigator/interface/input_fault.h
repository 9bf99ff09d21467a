// An InputFault is the reason why an input message was not used.
#pragma once
#include <cstdint>
#include <string_view>

namespace leonav {

// On the wire: append only.
enum class InputFault : std::uint8_t {
  kNone = 0,
  kUndecodable = 1,
  kUnknownSchema = 2,
  kNotFinite = 3,
  kOutOfRange = 4,
  kTimeBackwards = 5,
  kDuplicate = 6,
  kTooMany = 7,
  kNotSane = 8,
  kTooFarAhead = 9,
  kOverlap = 10,  // with the interval before
};
std::string_view to_string(InputFault fault);

}  // namespace leonav
