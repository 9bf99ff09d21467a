#include "core/navigator/interface/input_fault.h"

namespace leonav {

std::string_view to_string(InputFault fault) {
  switch (fault) {
    case InputFault::kNone:
      return "none";
    case InputFault::kUndecodable:
      return "undecodable";
    case InputFault::kUnknownSchema:
      return "unknown_schema";
    case InputFault::kNotFinite:
      return "not_finite";
    case InputFault::kOutOfRange:
      return "out_of_range";
    case InputFault::kTimeBackwards:
      return "time_backwards";
    case InputFault::kDuplicate:
      return "duplicate";
    case InputFault::kTooMany:
      return "too_many";
    case InputFault::kNotSane:
      return "not_sane";
    case InputFault::kTooFarAhead:
      return "too_far_ahead";
    case InputFault::kOverlap:
      return "overlap";
    case InputFault::kTooOften:
      return "too_often";
    case InputFault::kUnauthenticated:
      return "unauthenticated";
  }
  return "unknown";
}

}  // namespace leonav
