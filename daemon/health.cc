#include "daemon/health.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <leonav/health_t.hpp>
#include <limits>

#include "core/navigator/outputs.h"
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
  add_count("imu gaps", counters->imu_gaps.get(), message);
  add_count("filter resets", counters->resets.get(), message);
  add_count("commits", counters->commits.get(), message);
  add_count("published", counters->published.get(), message);
  add_count("health dropped", counters->unpublished.get(), message);
  add_count("journaled", counters->journaled.get(), message);
  message->n_counts = static_cast<std::int32_t>(message->counts.size());
}

}  // namespace

std::span<const std::uint8_t> HealthMonitor::next() {
  judge();
  EngineCounters& counters = engine_->counters();
  health_t message{};
  message.time_ns = counters.solution_time_ns.get();
  message.sequence = static_cast<std::int64_t>(++sequence_);
  message.schema = wire::kSchema;
  message.status = status_;
  message.why = why_;
  message.source = std::string(to_string(static_cast<Source>(counters.source.get())));
  message.ekf_misses = counters.misses.get();
  message.worst_tick_us = static_cast<double>(counters.worst_tick_ns.take()) * 1e-3;
  message.worst_ekf_ms = static_cast<double>(counters.worst_epoch_ns.take()) * 1e-6;
  const RingStatistics rings[] = {engine_->inertial_ring(), engine_->gnss_ring(),
                                  engine_->out_ring()};
  for (int i = 0; i < 3; ++i) {
    message.queue_high_water_percent[i] = static_cast<std::int32_t>(rings[i].high_water_percent);
  }
  for (std::size_t i = 0; i < kSystemCount; ++i) {
    message.satellites_used[i] = static_cast<std::int32_t>(counters.satellites_used[i].get());
    const std::int64_t age_ms = counters.ephemeris_age_ms[i].get();
    message.ephemeris_age_s[i] =
        age_ms < 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(age_ms) * 1e-3;
  }
  message.memory_mb = resident_megabytes();
  message.uptime_s = static_cast<double>(uptime_.nanoseconds()) * 1e-9;
  add_counts(&counters, &message);
  bytes_.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes_.data(), 0, static_cast<int>(bytes_.size()));
  return bytes_;
}

void HealthMonitor::judge() {
  status_ = "OK";
  why_.clear();
  EngineCounters& counters = engine_->counters();
  const std::int64_t imu = counters.received[index_of(Channel::kImu)].get();
  const std::int64_t epochs = counters.received[index_of(Channel::kGnssEpoch)].get();
  const std::int64_t misses = counters.misses.get(), lost = sum(counters.lost);
  const std::uint64_t waits =
      engine_->inertial_ring().waits + engine_->gnss_ring().waits + engine_->out_ring().waits;
  if (counters.journal_failed.get() != 0) worsen("FAULT", "journal: " + engine_->journal_error());
  const auto source = static_cast<Source>(counters.source.get());
  if (source == Source::kNone) worsen("FAULT", "no solution yet");
  if (source == Source::kAligning) worsen("DEGRADED", "aligning");
  if (source == Source::kInsOnly) worsen("DEGRADED", "INS only");
  if (expects_imu_ && imu == last_imu_) worsen("DEGRADED", "no IMU in the last second");
  // GNSS may come as seldom as it is configured; only one that never came is a fault by itself.
  if (epochs == 0) worsen("DEGRADED", "no GNSS yet");
  if (misses > last_misses_) worsen("DEGRADED", "deadline missed");
  if (lost > last_lost_) worsen("DEGRADED", "inputs lost before they got here");
  if (waits > last_waits_) worsen("DEGRADED", "a queue was full");
  last_imu_ = imu;
  last_misses_ = misses;
  last_lost_ = lost;
  last_waits_ = waits;
}

void HealthMonitor::worsen(const char* status, const std::string& reason) {
  if (status_ != "FAULT") status_ = status;
  why_ += (why_.empty() ? "" : "; ") + reason;
}

}  // namespace leonav
