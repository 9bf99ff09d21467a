#include "daemon/health/health_monitor.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "core/navigator/interface/solution.h"
#include "daemon/health/internal/health_message.h"
#include "daemon/text/alignment_text.h"
#include "daemon/text/convention_text.h"

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

std::int64_t sum(const auto& gauges) {
  std::int64_t total = 0;
  for (const Gauge& gauge : gauges) total += gauge.get();
  return total;
}

}  // namespace

// An input that ends is a fault by its consequence only: without GNSS the inertial answer goes on.
HealthMonitor::HealthMonitor(Engine* engine, const NavigatorConfig& config)
    : engine_(engine),
      alignment_(config.alignment),
      horizontal_alert_limit_m_(config.integrity.horizontal_alert_limit_m),
      vertical_alert_limit_m_(config.integrity.vertical_alert_limit_m),
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
  evaluate(now_s);
  const auto last_source = static_cast<Source>(engine_->counters().source.get());
  HealthSummary summary;
  summary.sequence = ++sequence_;
  summary.status = status_;
  summary.why = why_;
  summary.source = solution_.dead ? Source::kNone : last_source;
  summary.uptime_s = now_s;
  encode_health(summary, engine_, &bytes_);
  return bytes_;
}

void HealthMonitor::evaluate(double now_s) {
  status_ = "OK";
  why_.clear();
  EngineCounters& counters = engine_->counters();
  evaluate_journal();
  evaluate_solution(now_s);
  if (expects_imu_) evaluate_stream(counters.accepted_imu.get(), now_s, &imu_);
  evaluate_stream(counters.accepted_epochs.get(), now_s, &gnss_);
  evaluate_conventions();
  if (uses_odometer_ && counters.accepted_odometer.get() > 0)
    evaluate_stream(counters.accepted_odometer.get(), now_s, &odometer_);
  const std::uint64_t waits =
      engine_->inertial_ring().waits + engine_->gnss_ring().waits + engine_->out_ring().waits;
  evaluate_count(counters.misses.get(), "deadline missed", &last_misses_);
  evaluate_count(counters.smoother_misses.get(), "smoother late", &last_smoother_misses_);
  evaluate_count(counters.smoother_failures.get(), "smoother failed", &last_smoother_failures_);
  evaluate_count(counters.keyframes_skipped.get(), "keyframes skipped", &last_keyframes_skipped_);
  evaluate_count(sum(counters.lost), "inputs lost before they got here", &last_lost_);
  evaluate_count(static_cast<std::int64_t>(waits), "a queue was full", &last_waits_);
}

// The navigation needs no journal: what is missing in it is said, and the next piece may be whole.
void HealthMonitor::evaluate_journal() {
  const Journal& journal = engine_->journal();
  const std::string failure = journal.failure();
  if (!failure.empty()) worsen("FAULT", "journal: " + failure);
  if (journal.is_stalled()) worsen("DEGRADED", "journal: the disk does not answer");
  evaluate_count(journal.counters().lost_others.get(), "journal: messages are lost",
                 &last_lost_journal_);
  evaluate_count(journal.counters().lost_solutions.get(), "journal: solutions are left out",
                 &last_left_out_);
}

// A mistake in the configuration or in what feeds the daemon: it stays until somebody has put it
// right and started anew.
void HealthMonitor::evaluate_conventions() {
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
void HealthMonitor::evaluate_count(std::int64_t count, const char* reason, std::int64_t* last) {
  if (count > *last) worsen("DEGRADED", reason);
  *last = count;
}

void HealthMonitor::evaluate_solution(double now_s) {
  EngineCounters& counters = engine_->counters();
  const auto source = static_cast<Source>(counters.source.get());
  if (source == Source::kNone) {
    worsen("FAULT", "no solution yet");
    return;
  }
  evaluate_stream(counters.solution_time_ns.get(), now_s, &solution_);
  if (solution_.dead) return;  // then the last source says nothing
  if (source == Source::kAligning) {
    // Between an attitude and the first answer with it nothing lacks any more.
    const std::string lacks =
        to_text(unpack_alignment_need(counters.alignment_need.get()), alignment_);
    worsen("DEGRADED", lacks.empty() ? "aligning" : "aligning: " + lacks);
  }
  if (source == Source::kInsOnly) {
    worsen("DEGRADED", expects_imu_ ? "INS only" : "prediction without GNSS");
  }
  evaluate_levels();
}

// A solution that may be further off than its user allows. The level itself is a field of HEALTH:
// in the reason it would change, and be logged, every second.
void HealthMonitor::evaluate_levels() {
  const EngineCounters& counters = engine_->counters();
  const auto compare = [&](const std::string& name, const Gauge& level, double limit_m) {
    if (limit_m == 0.0) return;
    const std::int64_t micro = level.get();
    if (micro < 0) return worsen("DEGRADED", name + " protection level unknown");
    if (static_cast<double>(micro) * 1e-6 <= limit_m) return;
    char limit[32];
    std::snprintf(limit, sizeof limit, "%.2f m", limit_m);
    worsen("DEGRADED", name + " protection level above its alert limit of " + limit);
  };
  compare("horizontal", counters.horizontal_protection_micro, horizontal_alert_limit_m_);
  compare("vertical", counters.vertical_protection_micro, vertical_alert_limit_m_);
}

void HealthMonitor::evaluate_stream(std::int64_t number, double now_s, Stream* stream) {
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
