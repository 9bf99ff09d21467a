#include "daemon/health/internal/health_message.h"

#include <unistd.h>

#include <cstdio>
#include <leonav/health_t.hpp>
#include <limits>

#include "core/navigator/interface/input_fault.h"
#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

double resident_megabytes() {
  std::FILE* file = std::fopen("/proc/self/statm", "r");
  if (file == nullptr) return 0.0;
  long total = 0, resident = 0;
  const int fields = std::fscanf(file, "%ld %ld", &total, &resident);
  std::fclose(file);
  return fields == 2 ? static_cast<double>(resident * sysconf(_SC_PAGESIZE)) / 1e6 : 0.0;
}

void add_count(const std::string& name, std::int64_t value, health_t* message) {
  if (value == 0) return;
  count_t count;
  count.name = name;
  count.value = value;
  message->counts.push_back(count);
}

// Returns the value of a gauge in its unit; NaN for the -1 of "none".
double scaled(const Gauge& gauge, double unit) {
  const std::int64_t value = gauge.get();
  return value < 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(value) * unit;
}
double age_s(const Gauge& age_ms) { return scaled(age_ms, 1e-3); }

// Without a solution there is no level, though that of the last one is still there.
void add_levels(const EngineCounters& counters, Source source, health_t* message) {
  const double unit = source == Source::kNone ? std::numeric_limits<double>::quiet_NaN() : 1e-6;
  message->horizontal_protection_m = scaled(counters.horizontal_protection_micro, unit);
  message->vertical_protection_m = scaled(counters.vertical_protection_micro, unit);
  message->heading_protection_rad = scaled(counters.heading_protection_micro, unit);
}

// What is learned about the errors of one observable, over all classes and by class.
void add_learned(const std::string& observable, const LearnedGauges& gauges, health_t* message) {
  for (std::size_t i = 0; i < gauges.size(); ++i) {
    const std::string of = i == 0 ? "" : " " + std::string(kLearnedClassNames[i - 1]);
    add_count(observable + " sigma %" + of, gauges[i].sigma_percent.get(), message);
    add_count(observable + " time ms" + of, gauges[i].time_ms.get(), message);
  }
}

void add_journal_counts(const Journal& journal, health_t* message) {
  const JournalCounters& counters = journal.counters();
  add_count("journaled", counters.journaled.get(), message);
  add_count("journal lost", counters.lost_others.get(), message);
  add_count("journal solutions left out", counters.lost_solutions.get(), message);
  add_count("journal failures", counters.failures.get(), message);
  add_count("journal unconfirmed", counters.unsynced.get(), message);
  add_count("journal pieces", counters.pieces.get(), message);
  add_count("journal pieces deleted", counters.deleted.get(), message);
  add_count("journal pieces kept", counters.kept.get(), message);
  add_count("journal pieces undeletable", counters.undeletable.get(), message);
  add_count("journal memory %", static_cast<std::int64_t>(journal.ring().high_water_percent),
            message);
}

std::int64_t event_count(const EngineCounters& counters, EventKind kind) {
  return counters.events[static_cast<std::size_t>(kind)].get();
}

void add_counts(EngineCounters* counters, health_t* message) {
  for (const Channel channel : kInputChannels) {
    const std::string name(name_of(channel));
    add_count("received " + name, counters->received[index_of(channel)].get(), message);
    add_count("refused " + name, counters->refused[index_of(channel)].get(), message);
    add_count("lost " + name, counters->lost[index_of(channel)].get(), message);
  }
  for (std::size_t i = 0; i < counters->rejected.size(); ++i) {
    const std::string name(to_string(static_cast<InputFault>(i)));
    add_count("rejected " + name, counters->rejected[i].get(), message);
  }
  add_count("empty epochs", counters->empty_epochs.get(), message);
  add_count("late epochs", counters->late_epochs.get(), message);
  add_count("epochs without imu", counters->epochs_without_imu.get(), message);
  add_count("late odometer increments", counters->late_odometer.get(), message);
  add_count("imu gaps", counters->imu_gaps.get(), message);
  add_count("imu stamps smoothed", counters->imu_smoothed.get(), message);
  add_count("orbit fallbacks", counters->orbit_fallbacks.get(), message);
  add_count("orbits refused", counters->orbits_refused.get(), message);
  add_count("orbit returns", counters->orbit_returns.get(), message);
  add_count("satellite faults", event_count(*counters, EventKind::kSatelliteFault), message);
  add_count("widened predictions", counters->widened_predictions.get(), message);
  add_count("arcs joined", counters->arcs_joined.get(), message);
  add_learned("learned code", counters->learned[0], message);
  add_learned("learned doppler", counters->learned[1], message);
  for (const System system : kSystems)
    add_count("lasting code error cm " + std::string(to_string(system)),
              counters->lasting_cm[index_of(system)].get(), message);
  add_count("filter resets", event_count(*counters, EventKind::kFilterReset), message);
  add_count("checkpoints used", counters->checkpoints_used.get(), message);
  add_count("checkpoints ignored", counters->checkpoints_ignored.get(), message);
  add_count("commits", counters->commits.get(), message);
  add_count("smoother commits", counters->smoother_commits.get(), message);
  add_count("smoother failures", counters->smoother_failures.get(), message);
  add_count("smoother iterations", counters->smoother_iterations.get(), message);
  add_count("keyframes skipped", counters->keyframes_skipped.get(), message);
  add_count("published", counters->published.get(), message);
  add_count("health dropped", counters->unpublished.get(), message);
}

}  // namespace

void encode_health(const HealthSummary& summary, Engine* engine, std::vector<std::uint8_t>* bytes) {
  EngineCounters& counters = engine->counters();
  health_t message{};
  message.time_ns = counters.solution_time_ns.get();
  message.sequence = static_cast<std::int64_t>(summary.sequence);
  message.schema = wire::kHealthSchema;
  message.status = std::string(to_string(summary.status));
  message.why = summary.why;
  message.source = std::string(to_string(summary.source));
  message.ekf_misses = counters.misses.get();
  message.smoother_misses = counters.smoother_misses.get();
  message.worst_solve_ms = static_cast<double>(counters.worst_solve_ns.take()) * 1e-6;
  message.worst_tick_us = static_cast<double>(counters.worst_tick_ns.take()) * 1e-3;
  message.worst_ekf_ms = static_cast<double>(counters.worst_epoch_ns.take()) * 1e-6;
  const RingStatistics rings[] = {engine->inertial_ring(), engine->gnss_ring(), engine->out_ring()};
  for (int i = 0; i < 3; ++i) {
    message.queue_high_water_percent[i] = static_cast<std::int32_t>(rings[i].high_water_percent);
  }
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    message.satellites_used[i] = static_cast<std::int32_t>(counters.satellites_used[i].get());
    message.ephemeris_age_s[i] = age_s(counters.ephemeris_age_ms[i]);
  }
  for (std::size_t i = 0; i < counters.satellites_by_source.size(); ++i) {
    message.satellites_by_source[i] =
        static_cast<std::int32_t>(counters.satellites_by_source[i].get());
    message.age_by_source_s[i] = age_s(counters.age_by_source_ms[i]);
  }
  message.odometer_age_s = age_s(counters.odometer_age_ms);
  message.memory_mb = resident_megabytes();
  message.uptime_s = summary.uptime_s;
  add_levels(counters, summary.source, &message);
  add_counts(&counters, &message);
  add_journal_counts(engine->journal(), &message);
  message.n_counts = static_cast<std::int32_t>(message.counts.size());
  bytes->resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes->data(), 0, static_cast<int>(bytes->size()));
}

}  // namespace leonav
