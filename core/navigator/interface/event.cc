#include "core/navigator/interface/event.h"

namespace leonav {

std::string_view to_string(EventKind kind) {
  switch (kind) {
    case EventKind::kRejectedInput:
      return "rejected_input";
    case EventKind::kDeadlineMiss:
      return "deadline_miss";
    case EventKind::kFilterReset:
      return "filter_reset";
    case EventKind::kAligned:
      return "aligned";
    case EventKind::kImuGap:
      return "imu_gap";
    case EventKind::kLateEpoch:
      return "late_epoch";
    case EventKind::kEmptyEpoch:
      return "empty_epoch";
    case EventKind::kSolutionJump:
      return "solution_jump";
    case EventKind::kCapacity:
      return "capacity";
    case EventKind::kImprobable:
      return "improbable";
    case EventKind::kOrbitFallback:
      return "orbit_fallback";
    case EventKind::kOrbitReturn:
      return "orbit_return";
    case EventKind::kClockStep:
      return "clock_step";
    case EventKind::kNoneUsable:
      return "none_usable";
    case EventKind::kClockFallback:
      return "clock_fallback";
    case EventKind::kClockReturn:
      return "clock_return";
    case EventKind::kSmootherFailed:
      return "smoother_failed";
    case EventKind::kSourceChange:
      return "source_change";
    case EventKind::kConstraintsLeftOut:
      return "constraints_left_out";
    case EventKind::kConventionSuspect:
      return "convention_suspect";
    case EventKind::kOutageOver:
      return "outage_over";
    case EventKind::kReconverged:
      return "reconverged";
    case EventKind::kCheckpoint:
      return "checkpoint";
    case EventKind::kSatelliteFault:
      return "satellite_fault";
    case EventKind::kPredictionWidened:
      return "prediction_widened";
    case EventKind::kCommand:
      return "command";
    case EventKind::kOrbitRefused:
      return "orbit_refused";
  }
  return "unknown";
}

}  // namespace leonav
