#include "daemon/health.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <leonav/health_t.hpp>
#include <limits>

#include "core/navigator/outputs.h"
#include "daemon/alignment_text.h"
#include "daemon/convention_text.h"
#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

constexpr double kNever_s = std::numeric_limits<double>::infinity();
constexpr double kImuSilence_s = 0.9;           // next() comes once a second
constexpr double kOdometerSilence_s = 2.5;      // an increment lasts a second at most
constexpr double kIntervalsTolerated = 2.5;     // as until the answer counts as INS only
constexpr double kShortestSolutionGap_s = 2.0;  // a pause of `main` must not count as one
// As the longest hole over which the inertial answer is carried.
constexpr double kAnswerLife_s = 10.0;
constexpr double kIntervalsUntilFault = 10.0;

double solution_interval(const NavigatorConfig& config) {
  if (config.motion != MotionModel::kInertial) return config.realtime.epoch_interval_s;
  return config.solution_rate_hz > 0.0 ? 1.0 / config.solution_rate_hz : kNever_s;
}

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

// NaN for the -1 of "none in use".
double age_s(const Gauge& age_ms) {
  const std::int64_t value = age_ms.get();
  return value < 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(value) * 1e-3;
}

std::int64_t sum(const auto& gauges) {
  std::int64_t total = 0;
  for (const Gauge& gauge : gauges) total += gauge.get();
  return total;
}

void add_counts(EngineCounters* counters, health_t* message) {
  for (const Channel channel : kInputChannels) {
    const std::string name(name_of(channel));
    add_count("received " + name, counters->received[index_of(channel)].get(), message);
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
  add_count("orbit returns", counters->orbit_returns.get(), message);
  add_count("filter resets", counters->resets.get(), message);
  add_count("checkpoints used", counters->checkpoints_used.get(), message);
  add_count("checkpoints ignored", counters->checkpoints_ignored.get(), message);
  add_count("commits", counters->commits.get(), message);
  add_count("smoother commits", counters->smoother_commits.get(), message);
  add_count("smoother failures", counters->smoother_failures.get(), message);
  add_count("smoother iterations", counters->smoother_iterations.get(), message);
  add_count("keyframes skipped", counters->keyframes_skipped.get(), message);
  add_count("published", counters->published.get(), message);
  add_count("health dropped", counters->unpublished.get(), message);
  add_count("journaled", counters->journaled.get(), message);
  message->n_counts = static_cast<std::int32_t>(message->counts.size());
}

}  // namespace

// An input that ends is a fault by its consequence only: without GNSS the inertial answer goes on.
HealthMonitor::HealthMonitor(Engine* engine, const NavigatorConfig& config)
    : engine_(engine),
      alignment_(config.alignment),
      expects_imu_(config.motion == MotionModel::kInertial),
      uses_odometer_(expects_imu_ && config.vehicle.motion.constraints.odometer),
      imu_{"usable IMU", kImuSilence_s, kNever_s},
      gnss_{"usable GNSS", kIntervalsTolerated * config.realtime.epoch_interval_s, kNever_s},
      odometer_{"usable odometer", kOdometerSilence_s, kNever_s},
      solution_{
          "solution",
          std::max(kShortestSolutionGap_s, kIntervalsTolerated * solution_interval(config)),
          std::max(kAnswerLife_s, kIntervalsUntilFault * solution_interval(config)),
      } {}

std::span<const std::uint8_t> HealthMonitor::next(double now_s) {
  judge(now_s);
  EngineCounters& counters = engine_->counters();
  health_t message{};
  message.time_ns = counters.solution_time_ns.get();
  message.sequence = static_cast<std::int64_t>(++sequence_);
  message.schema = wire::kSchema;
  message.status = status_;
  message.why = why_;
  // The last solution's, unless that is worth nothing any more.
  message.source = std::string(
      to_string(solution_.dead ? Source::kNone : static_cast<Source>(counters.source.get())));
  message.ekf_misses = counters.misses.get();
  message.smoother_misses = counters.smoother_misses.get();
  message.worst_solve_ms = static_cast<double>(counters.worst_solve_ns.take()) * 1e-6;
  message.worst_tick_us = static_cast<double>(counters.worst_tick_ns.take()) * 1e-3;
  message.worst_ekf_ms = static_cast<double>(counters.worst_epoch_ns.take()) * 1e-6;
  const RingStatistics rings[] = {engine_->inertial_ring(), engine_->gnss_ring(),
                                  engine_->out_ring()};
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
  message.uptime_s = now_s;
  add_counts(&counters, &message);
  bytes_.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes_.data(), 0, static_cast<int>(bytes_.size()));
  return bytes_;
}

void HealthMonitor::judge(double now_s) {
  status_ = "OK";
  why_.clear();
  EngineCounters& counters = engine_->counters();
  if (counters.journal_failed.get() != 0) worsen("FAULT", "journal: " + engine_->journal_error());
  judge_solution(now_s);
  if (expects_imu_) judge_stream(counters.accepted_imu.get(), now_s, &imu_);
  judge_stream(counters.accepted_epochs.get(), now_s, &gnss_);
  judge_conventions();
  if (uses_odometer_ && counters.accepted_odometer.get() > 0)
    judge_stream(counters.accepted_odometer.get(), now_s, &odometer_);
  const std::uint64_t waits =
      engine_->inertial_ring().waits + engine_->gnss_ring().waits + engine_->out_ring().waits;
  judge_count(counters.misses.get(), "deadline missed", &last_misses_);
  judge_count(counters.smoother_misses.get(), "smoother late", &last_smoother_misses_);
  judge_count(counters.smoother_failures.get(), "smoother failed", &last_smoother_failures_);
  judge_count(counters.keyframes_skipped.get(), "keyframes skipped", &last_keyframes_skipped_);
  judge_count(sum(counters.lost), "inputs lost before they got here", &last_lost_);
  judge_count(static_cast<std::int64_t>(waits), "a queue was full", &last_waits_);
}

// A mistake in the configuration or in what feeds the daemon: it stays until somebody has put it
// right and started anew.
void HealthMonitor::judge_conventions() {
  EngineCounters& counters = engine_->counters();
  suspicions_.clear();
  for (std::size_t i = 0; i < kConventionCount; ++i) {
    if (counters.conventions[i].get() == 0) continue;
    const double value = static_cast<double>(counters.convention_milli[i].get()) * 1e-3;
    const std::string text = convention_text(static_cast<Convention>(i), value);
    suspicions_ += (suspicions_.empty() ? "" : "; ") + text;
  }
  if (!suspicions_.empty()) worsen("DEGRADED", suspicions_);
}

// Degraded where it has grown since the last look.
void HealthMonitor::judge_count(std::int64_t count, const char* reason, std::int64_t* last) {
  if (count > *last) worsen("DEGRADED", reason);
  *last = count;
}

void HealthMonitor::judge_solution(double now_s) {
  EngineCounters& counters = engine_->counters();
  const auto source = static_cast<Source>(counters.source.get());
  if (source == Source::kNone) {
    worsen("FAULT", "no solution yet");
    return;
  }
  judge_stream(counters.solution_time_ns.get(), now_s, &solution_);
  if (solution_.dead) return;  // then the last source says nothing
  if (source == Source::kAligning) {
    // Between an attitude and the first answer with it nothing lacks any more.
    const std::string lacks = to_text(unpacked(counters.alignment_need.get()), alignment_);
    worsen("DEGRADED", lacks.empty() ? "aligning" : "aligning: " + lacks);
  }
  if (source == Source::kInsOnly) {
    worsen("DEGRADED", expects_imu_ ? "INS only" : "prediction without GNSS");
  }
}

void HealthMonitor::judge_stream(std::int64_t number, double now_s, Stream* stream) {
  if (number != stream->number) {
    stream->number = number;
    stream->last_s = now_s;
  }
  const double silent_s = now_s - stream->last_s;
  stream->dead = silent_s > stream->fault_after_s;
  if (silent_s <= stream->degraded_after_s) return;
  worsen(stream->dead ? "FAULT" : "DEGRADED",
         "no " + std::string(stream->name) + " for " +
             std::to_string(static_cast<std::int64_t>(std::llround(silent_s))) + " s");
}

void HealthMonitor::worsen(const char* status, const std::string& reason) {
  if (status_ != "FAULT") status_ = status;
  why_ += (why_.empty() ? "" : "; ") + reason;
}

}  // namespace leonav
