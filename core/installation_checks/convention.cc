#include "core/installation_checks/convention.h"

namespace leonav {

std::string_view to_string(Convention convention) {
  switch (convention) {
    case Convention::kNone:
      return "none";
    case Convention::kForceInG:
      return "force_in_g";
    case Convention::kForceUnit:
      return "force_unit";
    case Convention::kGravityMissing:
      return "gravity_missing";
    case Convention::kIncrementsTimesInterval:
      return "increments_times_interval";
    case Convention::kRatesAsIncrements:
      return "rates_as_increments";
    case Convention::kGyrosInDegrees:
      return "gyros_in_degrees";
    case Convention::kGyroUnit:
      return "gyro_unit";
    case Convention::kForceSign:
      return "force_sign";
    case Convention::kGyroSign:
      return "gyro_sign";
    case Convention::kGyroAxes:
      return "gyro_axes";
    case Convention::kThirdAxisUp:
      return "third_axis_up";
    case Convention::kTilted:
      return "tilted";
    case Convention::kForwardLeftUp:
      return "forward_left_up";
    case Convention::kRightForwardUp:
      return "right_forward_up";
    case Convention::kForwardRightExchanged:
      return "forward_right_exchanged";
    case Convention::kMirrored:
      return "mirrored";
    case Convention::kBackwards:
      return "backwards";
    case Convention::kTurned:
      return "turned";
    case Convention::kLeapSeconds:
      return "leap_seconds";
    case Convention::kStampOffset:
      return "stamp_offset";
    case Convention::kLeverArmSign:
      return "lever_arm_sign";
    case Convention::kLeverArm:
      return "lever_arm";
    case Convention::kDopplerSign:
      return "doppler_sign";
    case Convention::kDopplerUnit:
      return "doppler_unit";
    case Convention::kSignalsExchanged:
      return "signals_exchanged";
    case Convention::kCodesExchanged:
      return "codes_exchanged";
    case Convention::kGyroRange:
      return "gyro_range";
    case Convention::kOrbits:
      return "orbits";
  }
  return "unknown";
}

}  // namespace leonav
