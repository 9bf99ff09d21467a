#include "daemon/health/health_reason.h"

#include <array>

namespace leonav {
namespace {

using enum HealthReason;
using enum HealthStatus;

// One look at HEALTH is a second: what happens at once in every few looks is held over them, so
// that the status does not flap. Events of the estimator are held for half a minute.
constexpr double kAtOnce_s = 0.0, kLooks_s = 5.0, kEvent_s = 30.0, kDrift_s = 600.0;

constexpr std::array<HealthReasonEntry, kHealthReasonCount> kEntries = {{
    {kNoSolutionYet, kFault, "no solution yet", "", kAtOnce_s},
    {kSolutionEnded, kFault, "the solution has ended", "the reasons beside this one say why",
     kAtOnce_s},
    {kThreadHangs, kFault, "a thread hangs", "the watchdog of the service manager restarts leonavd",
     kAtOnce_s},
    {kJournalFails, kFault, "journal", "look at space and permissions of its disk", kAtOnce_s},
    {kSolutionLate, kDegraded, "no solution of late", "the reasons beside this one say why",
     kAtOnce_s},
    {kAligning, kDegraded, "aligning", "", kAtOnce_s},
    {kInsOnly, kDegraded, "INS only", "wait for satellites (the sigma grows until then)", kLooks_s},
    {kPredictionOnly, kDegraded, "prediction without GNSS",
     "wait for satellites (the sigma grows until then)", kLooks_s},
    {kLevelAboveLimit, kDegraded, "protection level",
     "use the solution for nothing that needs this accuracy", kLooks_s},
    {kNoImu, kDegraded, "no usable IMU", "look at its sender", kLooks_s},
    {kNoGnss, kDegraded, "no usable GNSS", "look at its sender and the antenna", kLooks_s},
    {kNoOdometer, kDegraded, "no usable odometer", "look at its sender", kLooks_s},
    {kInputRejected, kDegraded, "a tenth or more of an input is rejected",
     "look at its sender and the events rejected_input", kLooks_s},
    {kInputLost, kDegraded, "inputs lost before they got here",
     "raise recv_buf_size in lcm.url, or look at the sender", kLooks_s},
    {kImuGaps, kDegraded, "the IMU stream has gaps", "find out why its sender loses samples",
     kLooks_s},
    {kConvention, kDegraded, "", "", kAtOnce_s},
    {kWithoutOrbit, kDegraded, "more satellites are without an orbit than with one",
     "look at the source of ephemerides", kLooks_s},
    {kPreciseEnded, kDegraded, "no precise orbit or correction is in use any more",
     "look at the source of corrections", kLooks_s},
    {kOrbitsRefused, kDegraded, "precise orbits contradict the broadcast ones",
     "look at the sources of corrections and ephemerides (the broadcast ones are used)", kLooks_s},
    {kMostRejected, kDegraded, "more than half of the measurements contradict the solution",
     "check antenna, orbits, IMU axes and time stamps if it stays (among houses it passes)",
     kLooks_s},
    {kLastingErrors, kDegraded, "codes are off by a metre or more for minutes",
     "check orbits, clocks and the antenna's place", kLooks_s},
    {kSatellitesDrift, kDegraded, "the carriers of several satellites drift away from the others",
     "suspect a spoofer, or orbits of another day", kDrift_s},
    {kFilterStartedOver, kDegraded, "the filter has started over",
     "normal once after an outage or a command (the events filter_reset have the numbers)",
     kEvent_s},
    {kSolutionJumped, kDegraded, "the solution has jumped",
     "normal after an outage (the events solution_jump say how far)", kEvent_s},
    {kPredictionWidened, kDegraded, "measurements have contradicted the prediction",
     "check IMU axes and time stamps if it comes back without an outage", kEvent_s},
    {kImprobable, kDegraded, "innovations are twice as large as expected",
     "check the sigmas under gnss, the axes and the lever arm", kEvent_s},
    {kConstraintsLeftOut, kDegraded, "the vehicle does not move as vehicle.kind says",
     "check vehicle.kind and vehicle.mounting_rpy_deg (wheels that slide pass)", kEvent_s},
    {kDeadlineMissed, kDegraded, "deadline missed", "look at the machine's load", kLooks_s},
    {kSmootherLate, kDegraded, "smoother late",
     "look at the machine's load (the filter answers meanwhile)", kLooks_s},
    {kSmootherFailed, kDegraded, "smoother failed", "the filter answers meanwhile", kLooks_s},
    {kKeyframesSkipped, kDegraded, "keyframes skipped", "look at the machine's load", kLooks_s},
    {kQueueFull, kDegraded, "a queue was full",
     "look for a sender of many messages at once, else at the machine's load", kLooks_s},
    {kJournalStalled, kDegraded, "journal: the disk does not answer", "look at the disk",
     kAtOnce_s},
    {kJournalLost, kDegraded, "journal: messages are lost",
     "use a faster disk or raise journal.buffer_mb", kAtOnce_s},
    {kJournalLeftOut, kDegraded, "journal: solutions are left out",
     "use a faster disk, or set journal.outputs to thinned or none", kAtOnce_s},
    {kJournalUnsynced, kDegraded, "journal: the disk has not confirmed what was written",
     "look at the disk's health and the kernel's log", kAtOnce_s},
    {kNoCheckpoint, kDegraded, "no checkpoint can be written",
     "look at checkpoint.path and its disk", kLooks_s},
}};

constexpr bool is_in_order() {
  for (std::size_t i = 0; i < kEntries.size(); ++i) {
    if (static_cast<std::size_t>(kEntries[i].reason) != i) return false;
  }
  return true;
}
static_assert(is_in_order());

}  // namespace

std::string_view to_string(HealthStatus status) {
  switch (status) {
    case kOk:
      return "OK";
    case kDegraded:
      return "DEGRADED";
    case kFault:
      return "FAULT";
  }
  return "unknown";
}

std::span<const HealthReasonEntry> health_reasons() { return kEntries; }

const HealthReasonEntry& entry_of(HealthReason reason) {
  return kEntries[static_cast<std::size_t>(reason)];
}

std::string health_reasons_as_markdown() {
  std::string text = "| status | reason | what to do | stays for |\n|---|---|---|---|\n";
  for (const HealthReasonEntry& entry : kEntries) {
    const std::string what =
        entry.text.empty() ? "a convention is broken" : "`" + std::string(entry.text) + "`";
    const std::string remedy(entry.remedy.empty() ? "what the sentence says" : entry.remedy);
    const int hold_s = static_cast<int>(entry.hold_s);
    text += "| " + std::string(to_string(entry.status)) + " | " + what + " | " + remedy + " | " +
            (hold_s == 0 ? "-" : std::to_string(hold_s) + " s") + " |\n";
  }
  return text;
}

}  // namespace leonav
