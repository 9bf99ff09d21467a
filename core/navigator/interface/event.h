// Event is something that a user should notice, with its stage, kind, code and value.
#pragma once
#include <cstdint>
#include <string_view>

#include "core/base/gps_time.h"
#include "core/navigator/interface/input_fault.h"

namespace leonav {

// The kinds of events; comments state the meaning of `code` and `value`. On the wire: append only.
enum class EventKind : std::uint8_t {
  kRejectedInput = 0,  // code: InputFault
  kDeadlineMiss = 1,   // code: 0 filter, 1 smoother; value: index of the epoch
  kFilterReset = 2,    // code: ResetCause; value: by code
  kAligned = 3,        // code: 1 if the gyro bias is known or a heading was set; value: sigma, rad
  kImuGap = 4,         // value: length of the gap, s
  kLateEpoch = 5,      // value: time behind the last issued epoch, s
  kEmptyEpoch = 6,     // value: index of the epoch
  kSolutionJump = 7,   // code: 1 if beyond three of its sigmas before; value: m
  kCapacity = 8,       // a fixed table was full; code: which, by stage
  kImprobable = 9,     // code: Improbable; value: mean ratio of innovations to sigmas
  // A satellite's broadcast elements replace its precise state. code: System, value: its number.
  kOrbitFallback = 10,
  kOrbitReturn = 11,  // a precise state replaces broadcast elements; code, value: as 10
  kClockStep = 12,    // a clock stepped beyond its noise; code: ClockStep, value: m
  // All satellites are excluded for one reason, in several epochs. code: Reason, value: their
  // number.
  kNoneUsable = 13,
  kClockFallback = 14,   // the orbit file's clock replaces that of a clock file; as 10
  kClockReturn = 15,     // the clock of a clock file replaces the orbit file's; as 10
  kSmootherFailed = 16,  // the window starts over; code: SmootherStatus, value: epoch
  kSourceChange = 17,    // the anchor has another source; code: the new Source, value: epoch
  // Constraints on the motion contradict the filter. value: share of the instants; code: sum of the
  // excluded components: side 1, vertical 2, velocity at standstill 4, rate at standstill 8,
  // odometer 16.
  kConstraintsLeftOut = 18,
  kConventionSuspect = 19,  // an input breaks a convention; code: Convention, value: by code
  // Satellites are used again after 5 s or more. value: s without; code: step of the filter's
  // position in tenths of its 3D sigma.
  kOutageOver = 20,
  // The position's sigma is at most 1.5 times that before the outage. value: s since its end.
  kReconverged = 21,
  // A verdict on the checkpoint of an earlier run. code: CheckpointUse, value: by code.
  kCheckpoint = 22,
  // A satellite's carrier drifts away from the others'; it is not used for half an hour. code:
  // System, value: its number.
  kSatelliteFault = 23,
  // Measurements agree with each other against the prediction, whose covariance was widened. code:
  // Observable; value: the 1 sigma added per axis, m, of Dopplers m/s.
  kPredictionWidened = 24,
  // The answer to a command. code: CommandResult; value: the command's sequence number.
  kCommand = 25,
  // A satellite's precise orbit is metres from its broadcast elements, which replace it. code:
  // System, value: its number.
  kOrbitRefused = 26,
};

// Codes of EventKind::kCommand. On the wire: append only.
enum class CommandResult : std::uint8_t {
  kDone = 0,              // a heading before there is a position is kept until there is one
  kContradictsMotion = 1  // the vehicle drives in another direction, forward and in reverse
};
// Returns the name of a kind as outputs show it, for instance "filter_reset".
std::string_view to_string(EventKind kind);

// Codes of EventKind::kImprobable. On the wire: append only.
enum class Improbable : std::uint8_t { kCodes = 0, kDopplers = 1 };

// Codes of EventKind::kClockStep. On the wire: append only.
enum class ClockStep : std::uint8_t {
  kReceiver = 0,     // all codes and carriers have stepped
  kCodes = 1,        // all codes have stepped against the carriers
  kFirstSystem = 16  // plus System: the codes of one system have stepped against the others'
};

// Codes of EventKind::kFilterReset. The Sequencer emits kTimeBase, the GNSS stage any, the inertial
// stage kNotFinite, after which it waits for the next anchor.
enum class ResetCause : std::uint8_t {
  kCommand = 0,
  kTimeBase = 1,    // a time step of the inputs; value: s, new time minus old
  kPrediction = 2,  // measurements contradict the prediction; value: m, change of the position
  kOutage = 3,      // the prediction was too uncertain; value: m, change of the position
  kNotFinite = 4,   // a number has overflowed
  // Nearly all measurements were rejected. value: m, the new sigma of a filter that is restarted,
  // the discrepancy of the codes for one that is dropped.
  kLockedOut = 5,
  kHeading = 6,  // the heading was wrong; the alignment starts again. value: rad, its error
  // A filter that has started over takes the state of the smoother's window, which knows more;
  // value: m, change of the position.
  kWindow = 7,
  // No IMU sample came for so long that the attitude is unknown; value: s, so long.
  kImuGap = 8
};

// The stage that emits an event. On the wire: append only. Events are numbered per stage, so that
// their order does not depend on how threads interleave.
enum class Stage : std::uint8_t { kSequencer = 0, kInertial = 1, kGnss = 2, kSmoother = 3 };

// One event.
struct Event {
  std::uint64_t sequence = 0;  // counts the events of the stage, from 1
  Stage stage = Stage::kSequencer;
  GpsTime time;  // data time
  EventKind kind = EventKind::kRejectedInput;
  std::uint8_t code = 0;
  double value = 0.0;
};

}  // namespace leonav
