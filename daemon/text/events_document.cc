#include "daemon/text/events_document.h"

#include <array>
#include <cstddef>
#include <string_view>

#include "core/navigator/interface/event.h"
#include "core/navigator/interface/input_fault.h"
#include "daemon/text/reset_text.h"

namespace leonav {
namespace {

constexpr std::string_view kSystemCode = "system: 0 GPS, 1 Galileo, 2 BeiDou, 3 LEO";
constexpr std::string_view kSatelliteNumber = "the satellite's number";
constexpr std::string_view kEpochIndex = "index of the epoch";

constexpr int kResetCauses = static_cast<int>(ResetCause::kImuGap) + 1;  // the last one

struct KindEntry {
  EventKind kind;
  std::string_view code, value;
};

using enum EventKind;
// A test compares it with lcmtypes/event_t.lcm.
constexpr auto kKindEntries = std::to_array<KindEntry>({
    {kRejectedInput, "the fault", ""},
    {kDeadlineMiss, "0 filter, 1 smoother", kEpochIndex},
    {kFilterReset, "the cause", "by code"},
    {kAligned, "1 if the gyro bias is known or a heading was set", "1 sigma of the heading, rad"},
    {kImuGap, "", "length, s"},
    {kLateEpoch, "", "s behind the last epoch issued"},
    {kEmptyEpoch, "", kEpochIndex},
    {kSolutionJump, "1 if beyond three sigmas", "m"},
    {kCapacity, "what was full, by stage", kEpochIndex},
    {kImprobable, "0 codes, 1 Dopplers", "mean ratio of innovations to sigmas"},
    {kOrbitFallback, kSystemCode, kSatelliteNumber},
    {kOrbitReturn, kSystemCode, kSatelliteNumber},
    {kClockStep, "the clock", "m"},
    {kNoneUsable, "the reason, as in `EPOCH`", "number of satellites"},
    {kClockFallback, kSystemCode, kSatelliteNumber},
    {kClockReturn, kSystemCode, kSatelliteNumber},
    {kSmootherFailed, "the smoother's status", kEpochIndex},
    {kSourceChange, "the new source", kEpochIndex},
    {kConstraintsLeftOut, "sum of those left out", "share of the instants"},
    {kConventionSuspect, "the convention", "by code"},
    {kOutageOver, "step of the position, tenths of its 3D sigma", "s without satellites"},
    {kReconverged, "", "s since the outage ended"},
    {kCheckpoint, "what became of it", "by code"},
    {kSatelliteFault, kSystemCode, kSatelliteNumber},
    {kPredictionWidened, "0 codes, 1 carriers, 2 Dopplers",
     "1 sigma added per axis, m, of Dopplers m/s"},
    {kCommand, "0 done, 1 contradicts the motion", "the command's `sequence`"},
    {kOrbitRefused, kSystemCode, kSatelliteNumber},
});

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < kKindEntries.size(); ++i)
    if (static_cast<std::size_t>(kKindEntries[i].kind) != i) return false;
  return true;
}
static_assert(is_in_order());

std::string_view meaning_of(InputFault fault) {
  switch (fault) {
    case InputFault::kNone:
      return "none";
    case InputFault::kUndecodable:
      return "the bytes are no message of this type";
    case InputFault::kUnknownSchema:
      return "`schema` is not the one of the message";
    case InputFault::kNotFinite:
      return "a number is infinite, or NaN where one is required";
    case InputFault::kOutOfRange:
      return "a value is outside its range";
    case InputFault::kTimeBackwards:
      return "the stamp goes back";
    case InputFault::kDuplicate:
      return "the same stamp or the same signal came before";
    case InputFault::kTooMany:
      return "an array is longer than its limit, or a buffer is full";
    case InputFault::kNotSane:
      return "no sensor measures such values; of an IMU also: it repeats them";
    case InputFault::kTooFarAhead:
      return "the stamp is too far ahead of everything seen";
    case InputFault::kOverlap:
      return "the interval overlaps the one before";
    case InputFault::kTooOften:
      return "more than five commands in ten seconds of data time";
    case InputFault::kUnauthenticated:
      return "a command without a valid signature, where `commands.key_file` asks for one";
  }
  return "unknown";
}

std::string_view value_of(ResetCause cause) {
  switch (cause) {
    case ResetCause::kCommand:
    case ResetCause::kNotFinite:
      return "0";
    case ResetCause::kTimeBase:
      return "of the Sequencer's event: s, new time minus old; of the GNSS stage's: 0";
    case ResetCause::kPrediction:
      return "m between the two";
    case ResetCause::kOutage:
      return "m between old and new position";
    case ResetCause::kLockedOut:
      return "m, see below";
    case ResetCause::kHeading:
      return "rad that it was off by; it is aligned again";
    case ResetCause::kWindow:
      return "m between the two positions";
    case ResetCause::kImuGap:
      return "s without samples so far";
  }
  return "unknown";
}

std::string cell(std::string_view text) { return std::string(text.empty() ? "-" : text) + " |"; }

}  // namespace

std::string events_as_markdown() {
  std::string text = "| kind | name | code | value |\n|---|---|---|---|\n";
  for (const KindEntry& entry : kKindEntries) {
    text += "| " + cell(std::to_string(static_cast<int>(entry.kind))) + " `" +
            std::string(to_string(entry.kind)) + "` | " + cell(entry.code) + " " +
            cell(entry.value) + "\n";
  }
  text += "\n| code | name | meaning |\n|---|---|---|\n";
  for (std::size_t i = 1; i < kInputFaultCount; ++i) {
    const auto fault = static_cast<InputFault>(i);
    text += "| " + cell(std::to_string(i)) + " `" + std::string(to_string(fault)) + "` | " +
            cell(meaning_of(fault)) + "\n";
  }
  text += "\n| code | cause | value |\n|---|---|---|\n";
  for (int i = 0; i < kResetCauses; ++i) {
    const auto cause = static_cast<ResetCause>(i);
    text += "| " + cell(std::to_string(i)) + " " + cell(reset_text(cause)) + " " +
            cell(value_of(cause)) + "\n";
  }
  return text;
}

}  // namespace leonav
