// An Event is something that a user should notice, with the stage, kind, code and value.
#pragma once
#include <cstdint>
#include <string_view>

#include "core/base/gps_time.h"
#include "core/navigator/interface/input_fault.h"

namespace leonav {

// On the wire: append only.
enum class EventKind : std::uint8_t {
  kRejectedInput = 0,  // code: InputFault
  kDeadlineMiss = 1,   // code: 0 ekf, 1 smoother; value: epoch
  kFilterReset = 2,
  kAligned = 3,
  kImuGap = 4,     // value: seconds
  kLateEpoch = 5,  // value: seconds late
  kEmptyEpoch = 6,
  kSolutionJump = 7,    // value: metres
  kCapacity = 8,        // a fixed table was full; code says which
  kImprobable = 9,      // code: 0 codes, 1 Dopplers; value: innovations over their sigmas
  kOrbitFallback = 10,  // precise state lost, broadcast serves; code: system, value: number
  kOrbitReturn = 11,    // a precise state serves where broadcast did; code, value: as 10
  kClockStep = 12,      // a clock stepped beyond its noise; code: ClockStep, value: metres
  kNoneUsable = 13,  // all satellites left out, epoch after epoch; code: Reason, value: satellites
  kClockFallback = 14,   // no clock of a clock file, the orbit's serves; code, value: as 10
  kClockReturn = 15,     // a clock file's serves, again or at first; code, value: as 10
  kSmootherFailed = 16,  // the window starts over; code: SmootherStatus, value: epoch
  kSourceChange = 17,    // the anchor has another source; code: the new Source, value: epoch
  // Constraints on the motion contradict the filter; value: share of the instants; code: sum of
  // those left out: side 1, vertical 2, velocity at standstill 4, rate at standstill 8,
  // odometer 16.
  kConstraintsLeftOut = 18,
  kConventionSuspect = 19,  // an input breaks a convention; code: Convention, value: by code
  // Satellites are back after 5 s or more; value: seconds without; code: step of the filter's
  // position in tenths of its 3D sigma.
  kOutageOver = 20,
  kReconverged = 21,  // the sigma is at most 1.5 times that before the outage; value: seconds since
  kCheckpoint = 22,   // the checkpoint of an earlier run; code: CheckpointUse, value: by code
};
std::string_view to_string(EventKind kind);

// Codes of EventKind::kClockStep. On the wire: append only.
enum class ClockStep : std::uint8_t {
  kReceiver = 0,     // all codes and carriers
  kCodes = 1,        // all codes against the carriers
  kFirstSystem = 16  // plus System: that system's codes against those of the others
};

// Codes of EventKind::kFilterReset. The Sequencer emits kTimeBase, the GNSS stage any, the inertial
// stage kNotFinite (it waits for the next anchor).
enum class ResetCause : std::uint8_t {
  kCommand = 0,
  kTimeBase = 1,
  kPrediction = 2,
  kOutage = 3,
  kNotFinite = 4,
  kLockedOut = 5,  // value: m, the new sigma or, after a restart, the old error
  kHeading = 6     // value: rad, error of the heading, which is aligned anew
};

// The stage that emits. On the wire: append only. Event sequences count per stage, so that their
// order does not depend on how threads interleave.
enum class Stage : std::uint8_t { kSequencer = 0, kInertial = 1, kGnss = 2, kSmoother = 3 };

struct Event {
  std::uint64_t sequence = 0;
  Stage stage = Stage::kSequencer;
  GpsTime time;  // data time
  EventKind kind = EventKind::kRejectedInput;
  std::uint8_t code = 0;
  double value = 0.0;
};

}  // namespace leonav
