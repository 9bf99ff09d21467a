#include "daemon/engine/internal/stage_sink.h"

#include <algorithm>
#include <cmath>

#include "daemon/text/alignment_text.h"
#include "daemon/threads/wall_clock.h"

namespace leonav {

namespace {

constexpr double kLargeJump_m = 1.0;

// Returns a protection level as its gauge holds it.
std::int64_t micro(double level) {
  return std::isnan(level) ? -1 : std::llround(std::min(level * 1e6, 1e15));
}

void count_learned(const ObservableErrors& errors, LearnedGauges* to) {
  for (std::size_t i = 0; i < to->size(); ++i) {
    const LearnedError& of = i == 0 ? errors.all : errors.classes[i - 1];
    (*to)[i].sigma_percent.set(std::llround(of.sigma_factor * 1e2));
    (*to)[i].time_ms.set(std::llround(of.correlation_time_s * 1e3));
  }
}

void count_reasons(const EpochReport& report, EngineCounters* counters) {
  constexpr double kHalf = 0.5;  // of the full weight
  if (!report.satellites.empty()) {
    std::array<std::int64_t, kReasonCount> satellites{};
    for (const SatelliteReport& satellite : report.satellites)
      ++satellites[static_cast<std::size_t>(satellite.reason)];
    for (std::size_t i = 0; i < satellites.size(); ++i)
      counters->satellites_by_reason[i].set(satellites[i]);
  }
  const auto contradicts = [](const AidingReport& aiding) {
    return aiding.reason == Reason::kOutlier || aiding.weight_factor < kHalf;
  };
  counters->measurements.add(static_cast<std::int64_t>(report.aiding.size()));
  counters->contradicting_measurements.add(
      std::count_if(report.aiding.begin(), report.aiding.end(), contradicts));
}

void count_checkpoint(const Event& event, EngineCounters* counters) {
  const auto use = static_cast<CheckpointUse>(event.code);
  const std::int64_t milli = std::llround(std::clamp(event.value, -1e12, 1e12) * 1e3);
  if (is_of_calibration(use)) {
    counters->calibration_milli.set(milli);
    counters->calibration_use.set(event.code + 1);
    return;
  }
  counters->checkpoint_milli.set(milli);
  counters->checkpoint_use.set(event.code + 1);
  const bool used = use == CheckpointUse::kUsed;
  (used ? counters->checkpoints_used : counters->checkpoints_ignored).add(1);
}

auto& conventions_of(Stage stage, EngineCounters* counters) {
  return stage == Stage::kSequencer ? counters->lasting_conventions : counters->conventions;
}

void count_convention(const Event& event, EngineCounters* counters) {
  if (event.code >= kConventionCount) return;
  ConventionGauge& gauge = conventions_of(event.stage, counters)[event.code];
  gauge.milli.set(std::llround(std::clamp(event.value * 1e3, -1e15, 1e15)));
  gauge.events.add(1);
}

// What wrong stamps can look like. Wrong stamps of epochs displace the satellites on their orbits.
constexpr std::array kOfStamps = {Convention::kLeapSeconds, Convention::kStampOffset,
                                  Convention::kOrbits};

// Where the time of the inputs has stepped, what a stage had found about stamps is void. The stage
// restarts its search and reports again what is still wrong. Findings about axes, units and lever
// arms stay.
void note_reset(const Event& event, EngineCounters* counters) {
  const auto cause = static_cast<ResetCause>(event.code);
  if (cause != ResetCause::kWindow) {
    counters->reset_cause.set(event.code);
    counters->filter_starts.add(1);
  }
  if (cause != ResetCause::kTimeBase) return;
  for (const Convention convention : kOfStamps) {
    ConventionGauge& gauge =
        conventions_of(event.stage, counters)[static_cast<std::size_t>(convention)];
    gauge.void_events.set(gauge.events.get());
  }
}

}  // namespace

void StageSink::on_solution(const Solution& solution) {
  counters_->horizontal_protection_micro.set(micro(solution.horizontal_protection_m));
  counters_->vertical_protection_micro.set(micro(solution.vertical_protection_m));
  counters_->heading_protection_micro.set(micro(solution.heading_protection));
  counters_->solution_time_ns.set(solution.time.nanoseconds());
  encoder_.on_solution(solution);
}

void StageSink::on_epoch(const EpochReport& report) {
  std::array<std::int64_t, kSystemCount> used{}, age;
  std::array<std::int64_t, 2> by_source{}, age_by_source;  // broadcast, precise
  age.fill(-1);
  age_by_source.fill(-1);
  for (const SatelliteReport& satellite : report.satellites) {
    const OrbitChange change = orbit_source_monitor_.update(satellite.satellite, satellite.source,
                                                            satellite.clock_from_file);
    if (change == OrbitChange::kFallback) counters_->orbit_fallbacks.add(1);
    if (change == OrbitChange::kReturn) counters_->orbit_returns.add(1);
    if (!is_used(satellite.reason)) continue;
    const std::size_t system = index_of(satellite.satellite.system);
    ++used[system];
    const auto age_ms = static_cast<std::int64_t>(satellite.ephemeris_age_s * 1e3);
    age[system] = std::max(age[system], age_ms);
    if (satellite.source == OrbitSource::kNone) continue;
    const std::size_t source = satellite.source == OrbitSource::kPrecise ? 1 : 0;
    ++by_source[source];
    age_by_source[source] = std::max(age_by_source[source], age_ms);
  }
  for (std::size_t i = 0; i < by_source.size(); ++i) {
    counters_->satellites_by_source[i].set(by_source[i]);
    counters_->age_by_source_ms[i].set(age_by_source[i]);
  }
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    counters_->satellites_used[i].set(used[i]);
    counters_->ephemeris_age_ms[i].set(age[i]);
  }
  if (report.learned_errors.learned) {
    count_learned(report.learned_errors.code, &counters_->learned[0]);
    count_learned(report.learned_errors.doppler, &counters_->learned[1]);
    for (std::size_t i = 0; i < kSystemCount; ++i)
      counters_->lasting_cm[i].set(std::llround(report.learned_errors.lasting_m[i] * 1e2));
  }
  count_reasons(report, counters_);
  if (!report.empty) counters_->orbits_refused.set(report.orbits_refused);
  counters_->widened_predictions.add(report.widened_predictions);
  counters_->arcs_joined.add(report.arcs_joined);
  counters_->alignment_need.set(pack_alignment_need(report.alignment));
  if (checkpoints_ != nullptr && report.checkpoint) checkpoints_->set(*report.checkpoint);
  encoder_.on_epoch(report);
}

void StageSink::on_event(const Event& event) {
  if (event.kind == EventKind::kFilterReset) note_reset(event, counters_);
  counters_->events[static_cast<std::size_t>(event.kind)].add(1);
  if (event.kind == EventKind::kSolutionJump && event.value > kLargeJump_m) {
    counters_->large_jumps.add(1);
    if (event.code != 0) counters_->surprising_jumps.add(1);
  }
  if (event.kind == EventKind::kConventionSuspect) count_convention(event, counters_);
  if (event.kind == EventKind::kCheckpoint) count_checkpoint(event, counters_);
  encoder_.on_event(event);
}

void StageSink::on_decision(const Decision& decision) {
  Gauge* counter = decision.committed ? &counters_->commits : &counters_->misses;
  if (decision.subject == Decision::Subject::kSmoother)
    counter = decision.committed ? &counters_->smoother_commits : &counters_->smoother_misses;
  if (decision.subject == Decision::Subject::kKeyframe) counter = &counters_->keyframes_skipped;
  counter->add(1);
  encoder_.on_decision(decision);
}

void StageSink::on_smoother(const SmootherReport& report) {
  if (report.status == SmootherStatus::kSingular || report.status == SmootherStatus::kDiverged)
    counters_->smoother_failures.add(1);
  counters_->smoother_iterations.add(report.iterations);
  counters_->smoother_shortened.add(report.shortened);
  counters_->smoother_left_to_chain.add(report.left_to_chain ? 1 : 0);
  encoder_.on_smoother(report);
}

void StageSink::take(Channel channel, ByteSpan bytes) {
  ring_.push(channel, wall_clock_us(), bytes);
}

}  // namespace leonav
