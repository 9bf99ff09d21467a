#include "core/gnss/measurement/measurement.h"

namespace leonav {

std::string_view to_string(Observable observable) {
  switch (observable) {
    case Observable::kCode:
      return "code";
    case Observable::kCarrier:
      return "carrier";
    case Observable::kDoppler:
      return "doppler";
  }
  return "";
}

std::string_view to_string(Reason reason) {
  switch (reason) {
    case Reason::kUsed:
      return "used";
    case Reason::kDownweighted:
      return "downweighted";
    case Reason::kOutlier:
      return "outlier";
    case Reason::kSystemDisabled:
      return "system_disabled";
    case Reason::kNoEphemeris:
      return "no_ephemeris";
    case Reason::kEphemerisTooOld:
      return "ephemeris_too_old";
    case Reason::kUnhealthy:
      return "unhealthy";
    case Reason::kLowElevation:
      return "low_elevation";
    case Reason::kLowCn0:
      return "low_cn0";
    case Reason::kNoUsableSignal:
      return "no_usable_signal";
    case Reason::kImplausible:
      return "implausible";
    case Reason::kSatelliteCap:
      return "satellite_cap";
    case Reason::kCapacity:
      return "capacity";
    case Reason::kNoPosition:
      return "no_position";
    case Reason::kNotSolved:
      return "not_solved";
    case Reason::kFaulty:
      return "faulty";
  }
  return "unknown";
}

}  // namespace leonav
