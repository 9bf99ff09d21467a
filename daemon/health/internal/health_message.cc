#include "daemon/health/internal/health_message.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <initializer_list>
#include <leonav/health_t.hpp>
#include <limits>

#include "core/navigator/interface/input_fault.h"
#include "daemon/health/internal/counter_sums.h"
#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

constexpr std::size_t kMostCounts = 256;  // more would be taken, and more memory with it
constexpr std::size_t kNameBytes = 48, kWhyBytes = 2048, kMessageBytes = 16 << 10;

double resident_megabytes() {
  const int descriptor = open("/proc/self/statm", O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return 0.0;
  std::array<char, 128> text{};
  const ssize_t size = read(descriptor, text.data(), text.size());
  close(descriptor);
  const char* const end = text.data() + std::max<ssize_t>(size, 0);
  const char* const second = std::find(static_cast<const char*>(text.data()), end, ' ');
  long pages = 0;
  if (second != end) std::from_chars(second + 1, end, pages);
  return static_cast<double>(pages * sysconf(_SC_PAGESIZE)) / (1 << 20);
}

// The counts of a message. A name is given in parts, which are joined in its place.
class Counts {
 public:
  explicit Counts(std::vector<count_t>* counts) : counts_(counts) {}

  void add(std::initializer_list<std::string_view> name, std::int64_t value) {
    if (value == 0) return;
    if (used_ == counts_->size()) counts_->emplace_back();
    count_t& count = (*counts_)[used_++];
    count.name.clear();
    for (const std::string_view part : name) count.name += part;
    count.value = value;
  }
  void add(std::string_view name, std::int64_t value) { add({name}, value); }
  std::size_t used() const { return used_; }

 private:
  std::vector<count_t>* counts_;
  std::size_t used_ = 0;
};

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
void add_learned(std::string_view observable, const LearnedGauges& gauges, Counts* counts) {
  for (std::size_t i = 0; i < gauges.size(); ++i) {
    const std::string_view space = i == 0 ? "" : " ", of = i == 0 ? "" : kLearnedClassNames[i - 1];
    counts->add({observable, " sigma %", space, of}, gauges[i].sigma_percent.get());
    counts->add({observable, " time ms", space, of}, gauges[i].time_ms.get());
  }
}

void add_journal_counts(const Journal& journal, Counts* counts) {
  const JournalCounters& of = journal.counters();
  counts->add("journaled", of.journaled.get());
  counts->add("journal lost", of.lost_others.get());
  counts->add("journal solutions left out", of.lost_solutions.get());
  counts->add("journal failures", of.failures.get());
  counts->add("journal unconfirmed", of.unsynced.get());
  counts->add("journal pieces", of.pieces.get());
  counts->add("journal pieces deleted", of.deleted.get());
  counts->add("journal pieces kept", of.kept.get());
  counts->add("journal pieces undeletable", of.undeletable.get());
  counts->add("journal memory %", static_cast<std::int64_t>(journal.ring().high_water_percent));
}

void add_counts(const EngineCounters& of, Counts* counts) {
  for (const Channel channel : kInputChannels) {
    const std::string_view name = name_of(channel);
    counts->add({"received ", name}, of.received[index_of(channel)].get());
    counts->add({"refused ", name}, of.refused[index_of(channel)].get());
    counts->add({"lost ", name}, of.lost[index_of(channel)].get());
  }
  for (std::size_t i = 0; i < of.rejected.size(); ++i) {
    const std::string_view name = to_string(static_cast<InputFault>(i));
    counts->add({"rejected ", name}, of.rejected[i].get());
  }
  counts->add("empty epochs", of.empty_epochs.get());
  counts->add("late epochs", of.late_epochs.get());
  counts->add("epochs without imu", of.epochs_without_imu.get());
  counts->add("late odometer increments", of.late_odometer.get());
  counts->add("imu gaps", of.imu_gaps.get());
  counts->add("imu stamps smoothed", of.imu_smoothed.get());
  counts->add("orbit fallbacks", of.orbit_fallbacks.get());
  counts->add("orbits refused", of.orbits_refused.get());
  counts->add("orbit returns", of.orbit_returns.get());
  counts->add("satellite faults", event_count(of, EventKind::kSatelliteFault));
  counts->add("widened predictions", of.widened_predictions.get());
  counts->add("arcs joined", of.arcs_joined.get());
  add_learned("learned code", of.learned[0], counts);
  add_learned("learned doppler", of.learned[1], counts);
  for (const System system : kSystems)
    counts->add({"lasting code error cm ", to_string(system)},
                of.lasting_cm[index_of(system)].get());
  counts->add("filter resets", event_count(of, EventKind::kFilterReset));
  counts->add("checkpoints used", of.checkpoints_used.get());
  counts->add("checkpoints ignored", of.checkpoints_ignored.get());
  counts->add("commits", of.commits.get());
  counts->add("smoother commits", of.smoother_commits.get());
  counts->add("smoother failures", of.smoother_failures.get());
  counts->add("smoother iterations", of.smoother_iterations.get());
  counts->add("smoother steps shortened", of.smoother_shortened.get());
  counts->add("smoother solves left to chain", of.smoother_left_to_chain.get());
  counts->add("keyframes skipped", of.keyframes_skipped.get());
  counts->add("published", of.published.get());
  counts->add("health dropped", of.unpublished.get());
}

}  // namespace

struct HealthMessage::Content {
  health_t message{};
};

HealthMessage::HealthMessage() : content_(std::make_unique<Content>()) {
  health_t& message = content_->message;
  message.counts.resize(kMostCounts);
  for (count_t& count : message.counts) count.name.reserve(kNameBytes);
  message.why.reserve(kWhyBytes);
  bytes_.reserve(kMessageBytes);
}

HealthMessage::~HealthMessage() = default;

std::span<const std::uint8_t> HealthMessage::encode(const HealthSummary& summary, Engine* engine) {
  EngineCounters& counters = engine->counters();
  health_t& message = content_->message;
  message.time_ns = counters.solution_time_ns.get();
  message.sequence = static_cast<std::int64_t>(summary.sequence);
  message.schema = wire::kHealthSchema;
  message.status = to_string(summary.status);
  message.why = summary.why;
  message.source = to_string(summary.source);
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
  Counts counts(&message.counts);
  add_counts(counters, &counts);
  add_journal_counts(engine->journal(), &counts);
  message.n_counts = static_cast<std::int32_t>(counts.used());
  bytes_.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(bytes_.data(), 0, static_cast<int>(bytes_.size()));
  return bytes_;
}

}  // namespace leonav
