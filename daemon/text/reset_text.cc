#include "daemon/text/reset_text.h"

namespace leonav {

std::string_view reset_text(ResetCause cause) {
  switch (cause) {
    case ResetCause::kCommand:
      return "by the command restart";
    case ResetCause::kTimeBase:
      return "the time of the inputs has stepped";
    case ResetCause::kPrediction:
      return "a point solution contradicts the filter";
    case ResetCause::kOutage:
      return "an outage has lost the position";
    case ResetCause::kNotFinite:
      return "a number was not finite";
    case ResetCause::kLockedOut:
      return "the filter has rejected nearly all measurements for long";
    case ResetCause::kHeading:
      return "the heading contradicts the motion";
    case ResetCause::kWindow:
      return "the filter has taken over the smoother's state";
    case ResetCause::kImuGap:
      return "no IMU sample has come for seconds: the attitude is unknown";
  }
  return "unknown";
}

}  // namespace leonav
