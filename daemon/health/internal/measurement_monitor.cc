#include "daemon/health/internal/measurement_monitor.h"

#include <algorithm>

#include "core/navigator/interface/solution.h"
#include "daemon/health/internal/counter_sums.h"

namespace leonav {
namespace {

constexpr std::int64_t kFewMeasurements = 50;
constexpr std::int64_t kLastingError_cm = 100;
constexpr std::int64_t kSeveralSatellites = 3;
constexpr std::int64_t kFewPrecise = 4;

}  // namespace

std::span<const Finding> MeasurementMonitor::look() {
  found_.clear();
  look_at_orbits();
  look_at_contradictions();
  look_at_lasting_errors();
  return found_.get();
}

void MeasurementMonitor::look_at_orbits() {
  const bool had_answer = static_cast<Source>(counters_->source.get()) != Source::kNone;
  const std::int64_t without = satellite_count(*counters_, Reason::kNoEphemeris) +
                               satellite_count(*counters_, Reason::kEphemerisTooOld);
  if (had_answer && 2 * without > sum(counters_->satellites_by_reason))
    found_.add(HealthReason::kWithoutOrbit);

  const std::int64_t precise = counters_->satellites_by_source[1].get();
  most_precise_ = std::max(most_precise_, precise);
  if (most_precise_ >= kFewPrecise && precise == 0 && counters_->satellites_by_source[0].get() > 0)
    found_.add(HealthReason::kPreciseEnded);
  if (counters_->orbits_refused.get() > 0) found_.add(HealthReason::kOrbitsRefused);
}

void MeasurementMonitor::look_at_contradictions() {
  measurements_.look(counters_->measurements.get());
  contradicting_.look(counters_->contradicting_measurements.get());
  if (measurements_.get() >= kFewMeasurements && 2 * contradicting_.get() > measurements_.get())
    found_.add(HealthReason::kMostRejected);

  satellite_faults_.look(event_count(*counters_, EventKind::kSatelliteFault));
  if (satellite_faults_.get() >= kSeveralSatellites) found_.add(HealthReason::kSatellitesDrift);
}

void MeasurementMonitor::look_at_lasting_errors() {
  detail_.clear();
  for (const System system : kSystems) {
    if (counters_->lasting_cm[index_of(system)].get() >= kLastingError_cm)
      append_to_list(to_string(system), &detail_);
  }
  if (!detail_.empty()) found_.add(HealthReason::kLastingErrors, detail_);
}

}  // namespace leonav
