// HealthReason is why HEALTH is not OK: a status, a sentence and a remedy each.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace leonav {

enum class HealthStatus : std::uint8_t { kOk, kDegraded, kFault };
std::string_view to_string(HealthStatus status);  // "OK", "DEGRADED", "FAULT"

// In the order in which HEALTH names those of one status.
enum class HealthReason : std::uint8_t {
  // answer
  kNoSolutionYet,
  kSolutionEnded,
  kThreadHangs,
  kJournalFails,
  kSolutionLate,
  kAligning,
  kInsOnly,
  kPredictionOnly,
  kLevelAboveLimit,
  // inputs
  kNoImu,
  kNoGnss,
  kNoOdometer,
  kInputRejected,
  kInputLost,
  kImuGaps,
  kConvention,
  // measurements
  kWithoutOrbit,
  kPreciseEnded,
  kOrbitsRefused,
  kMostRejected,
  kLastingErrors,
  kSatellitesDrift,
  // estimator
  kFilterStartedOver,
  kSolutionJumped,
  kPredictionWidened,
  kImprobable,
  kConstraintsLeftOut,
  // time
  kDeadlineMissed,
  kSmootherLate,
  kSmootherFailed,
  kKeyframesSkipped,
  kQueueFull,
  // disk
  kJournalStalled,
  kJournalLost,
  kJournalLeftOut,
  kJournalUnsynced,
  kNoCheckpoint,
};
inline constexpr std::size_t kHealthReasonCount = 37;

struct HealthReasonEntry {
  HealthReason reason;
  HealthStatus status;
  std::string_view text;    // what is the case, as HEALTH says it
  std::string_view remedy;  // what to do; empty where the detail says it
  double hold_s;            // how long it stays after it was last the case
};

// All of them, in the order of HealthReason.
std::span<const HealthReasonEntry> health_reasons();
const HealthReasonEntry& entry_of(HealthReason reason);

// The table of docs/operations/health.md.
std::string health_reasons_as_markdown();

}  // namespace leonav
