#include "daemon/health/health_monitor.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "core/navigator/interface/solution.h"
#include "daemon/health/internal/health_message.h"
#include "daemon/text/alignment_text.h"
#include "daemon/text/convention_text.h"

namespace leonav {
namespace {

constexpr double kNever_s = std::numeric_limits<double>::infinity();
constexpr double kImuSilence_s = 0.9;        // next() comes once a second
constexpr double kOdometerSilence_s = 2.5;   // an increment lasts a second at most
constexpr double kIntervalsTolerated = 2.5;  // as until the answer counts as INS only
constexpr double kShare = 0.1;               // of an input, that is rejected
constexpr std::int64_t kFewMessages = 5;     // fewer say nothing about a share
constexpr std::int64_t kFewMeasurements = 50;
constexpr std::int64_t kLastingError_cm = 100;
constexpr std::int64_t kSeveralSatellites = 3;
constexpr std::int64_t kFewPrecise = 4;
constexpr int kSettledLooks = 30;
constexpr double kShortestSolutionGap_s = 2.0;  // a pause of `main` must not count as one
// As the longest hole over which the inertial answer is carried.
constexpr double kAnswerLife_s = 10.0;
constexpr double kIntervalsUntilFault = 10.0;
constexpr std::size_t kDetailBytes = 256;
constexpr std::string_view kWaitsForEpoch =
    "the filter has started over and waits for the next GNSS epoch";

double solution_interval(const NavigatorConfig& config) {
  if (config.motion != MotionModel::kInertial) return config.realtime.epoch_interval_s;
  return config.solution_rate_hz > 0.0 ? 1.0 / config.solution_rate_hz : kNever_s;
}

std::int64_t sum(const auto& gauges) {
  std::int64_t total = 0;
  for (const Gauge& gauge : gauges) total += gauge.get();
  return total;
}

void append(std::string_view text, std::string* list) {
  if (!list->empty()) *list += ", ";
  *list += text;
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
      imu_{kImuSilence_s, kNever_s},
      gnss_{kIntervalsTolerated * config.realtime.epoch_interval_s, kNever_s},
      odometer_{kOdometerSilence_s, kNever_s},
      solution_{
          std::max(kShortestSolutionGap_s, kIntervalsTolerated * solution_interval(config)),
          std::max(kAnswerLife_s, kIntervalsUntilFault * solution_interval(config)),
      },
      any_imu_(imu_),
      any_gnss_(gnss_),
      any_odometer_(odometer_),
      message_(std::make_unique<HealthMessage>()) {
  detail_.reserve(kDetailBytes);
}

HealthMonitor::~HealthMonitor() = default;

std::span<const std::uint8_t> HealthMonitor::next(double now_s, std::string_view stalled_threads) {
  reasons_.begin(now_s);
  if (!stalled_threads.empty()) reasons_.raise(HealthReason::kThreadHangs, stalled_threads);
  judge_inputs(now_s);
  judge_starts();
  judge_conventions();
  judge_answer(now_s);
  judge_measurements();
  judge_estimator();
  judge_time();
  judge_disk(now_s);
  HealthSummary summary;
  summary.sequence = ++sequence_;
  summary.status = status();
  summary.why = why();
  summary.source =
      solution_.has_ended ? Source::kNone : static_cast<Source>(engine_->counters().source.get());
  summary.uptime_s = now_s;
  return message_->encode(summary, engine_);
}

void HealthMonitor::Stream::look(std::int64_t now_number, double now_s) {
  if (now_number != number) {
    number = now_number;
    last_s = now_s;
  }
  is_late = now_s - last_s > degraded_after_s;
  has_ended = now_s - last_s > fault_after_s;
}

void HealthMonitor::judge_answer(double now_s) {
  EngineCounters& counters = engine_->counters();
  const auto source = static_cast<Source>(counters.source.get());
  fault_ = why_no_answer();
  if (source == Source::kNone)
    return reasons_.raise(HealthReason::kNoSolutionYet, why_no_solution());
  solution_.look(counters.solution_time_ns.get(), now_s);
  // Then the last source says nothing.
  if (solution_.has_ended) return reasons_.raise(HealthReason::kSolutionEnded);
  fault_ = Fault::kNone;
  if (solution_.is_late) reasons_.raise(HealthReason::kSolutionLate);
  if (source == Source::kAligning) {
    // Between an attitude and the first answer with it nothing lacks any more.
    const AlignmentNeed need = unpack_alignment_need(counters.alignment_need.get());
    const AlignmentText text = to_text(need, alignment_);
    reasons_.raise(HealthReason::kAligning, {text.data(), text.size()});
  }
  if (source == Source::kInsOnly)
    reasons_.raise(expects_imu_ ? HealthReason::kInsOnly : HealthReason::kPredictionOnly);
  judge_levels();
}

// Adds " as ..." with the fault by which most inputs of the channel are rejected.
void HealthMonitor::append_fault(Channel channel) {
  const InputFault fault = faults_.most_frequent(channel);
  if (fault != InputFault::kNone) detail_.append(" as ").append(to_string(fault));
}

std::string_view HealthMonitor::with_fault(std::string_view text, Channel channel) {
  detail_.assign(text);
  append_fault(channel);
  return detail_;
}

// Returns why no epoch gets to the filter; "": they do.
std::string_view HealthMonitor::why_no_epoch() {
  const EngineCounters& counters = engine_->counters();
  const bool had_imu = counters.accepted_imu.get() > 0;
  if (counters.received[index_of(Channel::kGnssEpoch)].get() == 0) return "no GNSS has come";
  if (counters.accepted_epochs.get() == 0)
    return with_fault("all GNSS epochs are rejected", Channel::kGnssEpoch);
  if (expects_imu_ && counters.received[index_of(Channel::kImu)].get() == 0)
    return "no IMU sample has come";
  if (expects_imu_ && !had_imu) return with_fault("all IMU samples are rejected", Channel::kImu);
  if (expects_imu_ && imu_.is_late) return "no IMU sample is used any more";
  if (!gnss_.is_late) return "";
  const InputFault fault = faults_.most_frequent(Channel::kGnssEpoch);
  const bool wrong_time = fault == InputFault::kTimeBackwards || fault == InputFault::kTooFarAhead;
  if (!wrong_time || !expects_imu_) return "no GNSS epoch is used any more";
  // What was rejected before the start was compared with a time of the IMU that holds no more.
  if (starts_ > 0 && counters.received[index_of(Channel::kGnssEpoch)].get() <= received_at_start_)
    return kWaitsForEpoch;
  with_fault("the GNSS epochs are rejected", Channel::kGnssEpoch);
  detail_ += ", their time is not that of the IMU: compare the two clocks";
  return detail_;
}

// Returns what the first position waits for.
std::string_view HealthMonitor::why_no_solution() {
  const EngineCounters& counters = engine_->counters();
  const auto satellites = [&](Reason reason) {
    return counters.satellites_by_reason[static_cast<std::size_t>(reason)].get();
  };
  const std::int64_t measured = sum(counters.satellites_by_reason);
  if (const std::string_view inputs = why_no_epoch(); !inputs.empty()) return inputs;
  // The satellites are those of the epoch before; the first new one may be on its way.
  if (starts_ > 0 && counters.accepted_epochs.get() <= epochs_at_start_ + 1) return kWaitsForEpoch;
  if (measured == 0) return "the GNSS epochs are without satellites";
  std::size_t most = 0;
  for (std::size_t i = 0; i < kReasonCount; ++i) {
    if (is_used(static_cast<Reason>(i)) || i == static_cast<std::size_t>(Reason::kNotSolved))
      continue;
    if (counters.satellites_by_reason[i].get() > counters.satellites_by_reason[most].get())
      most = i;
  }
  const auto reason = static_cast<Reason>(most);
  if (reason == Reason::kUsed || 2 * satellites(reason) < measured)
    return "too few satellites with good codes so far";
  if (reason == Reason::kNoEphemeris)
    return "most satellites have no ephemeris: see that they are sent";
  detail_ = "most satellites are left out as ";
  detail_ += to_string(reason);
  return detail_;
}

// A solution that may be further off than its user allows. The level itself is a field of HEALTH:
// in the reason it would change, and be logged, every second.
void HealthMonitor::judge_levels() {
  const EngineCounters& counters = engine_->counters();
  detail_.clear();
  const auto compare = [&](std::string_view name, const Gauge& level, double limit_m) {
    if (limit_m == 0.0) return;
    const std::int64_t micro = level.get();
    if (micro >= 0 && static_cast<double>(micro) * 1e-6 <= limit_m) return;
    append(name, &detail_);
    if (micro < 0) {
      detail_ += " unknown";
      return;
    }
    char limit[64];
    std::snprintf(limit, sizeof limit, " above its alert limit of %.2f m", limit_m);
    detail_ += limit;
  };
  compare("horizontal", counters.horizontal_protection_micro, horizontal_alert_limit_m_);
  compare("vertical", counters.vertical_protection_micro, vertical_alert_limit_m_);
  if (!detail_.empty()) reasons_.raise(HealthReason::kLevelAboveLimit, detail_);
}

void HealthMonitor::judge_inputs(double now_s) {
  EngineCounters& counters = engine_->counters();
  faults_.look(counters);
  detail_.clear();
  for (const Channel channel : kInputChannels) {
    const std::size_t i = index_of(channel);
    InputRates& rates = inputs_[i];
    rates.received.look(counters.received[i].get());
    rates.refused.look(counters.refused[i].get());
    std::int64_t unused = rates.refused.get();
    // Of the streams it is known what the Sequencer has taken.
    if (channel == Channel::kImu) rates.accepted.look(counters.accepted_imu.get());
    if (channel == Channel::kGnssEpoch) rates.accepted.look(counters.accepted_epochs.get());
    if (channel == Channel::kImu || channel == Channel::kGnssEpoch)
      unused = std::max(unused, rates.received.get() - rates.accepted.get());
    const std::int64_t received = rates.received.get();
    if (received < kFewMessages ||
        static_cast<double>(unused) < kShare * static_cast<double>(received))
      continue;
    append(name_of(channel), &detail_);
    append_fault(channel);
  }
  if (!detail_.empty()) reasons_.raise(HealthReason::kInputRejected, detail_);
  if (expects_imu_)
    judge_stream(counters.accepted_imu.get(), now_s, Channel::kImu, HealthReason::kNoImu, &imu_,
                 &any_imu_);
  judge_stream(counters.accepted_epochs.get(), now_s, Channel::kGnssEpoch, HealthReason::kNoGnss,
               &gnss_, &any_gnss_);
  if (uses_odometer_ && counters.accepted_odometer.get() > 0)
    judge_stream(counters.accepted_odometer.get(), now_s, Channel::kOdometer,
                 HealthReason::kNoOdometer, &odometer_, &any_odometer_);
  raise_if_grown(HealthReason::kInputLost, sum(counters.lost));
  raise_if_grown(HealthReason::kImuGaps, counters.imu_gaps.get());
}

void HealthMonitor::judge_stream(std::int64_t number, double now_s, Channel channel,
                                 HealthReason reason, Stream* stream, Stream* any) {
  stream->look(number, now_s);
  any->look(engine_->counters().received[index_of(channel)].get(), now_s);
  if (!stream->is_late) return;
  if (any->is_late) return reasons_.raise(reason, "nothing comes");
  const bool rejected = faults_.most_frequent(channel) != InputFault::kNone;
  reasons_.raise(reason, rejected ? with_fault("messages come, but are rejected", channel)
                                  : "messages come, but too late");
}

// A mistake in the configuration or in what feeds the daemon. The reason stays until the mistake is
// mended and the daemon is started again.
void HealthMonitor::judge_conventions() {
  EngineCounters& counters = engine_->counters();
  std::array<std::optional<std::int64_t>, kConventionCount> milli;
  for (std::size_t i = 0; i < kConventionCount; ++i) {
    if (counters.conventions[i].get() != 0) milli[i] = counters.convention_milli[i].get();
  }
  if (std::exchange(suspected_, milli) != milli) {
    suspicions_.clear();
    for (std::size_t i = 0; i < kConventionCount; ++i) {
      if (!milli[i]) continue;
      const double value = static_cast<double>(*milli[i]) * 1e-3;
      const std::string text = convention_text(static_cast<Convention>(i), value);
      suspicions_ += (suspicions_.empty() ? "" : "; ") + text;
    }
  }
  if (!suspicions_.empty()) reasons_.raise(HealthReason::kConvention, suspicions_);
}

void HealthMonitor::judge_measurements() {
  EngineCounters& counters = engine_->counters();
  const auto satellites = [&](Reason reason) {
    return counters.satellites_by_reason[static_cast<std::size_t>(reason)].get();
  };
  const bool had_answer = static_cast<Source>(counters.source.get()) != Source::kNone;
  const std::int64_t without =
      satellites(Reason::kNoEphemeris) + satellites(Reason::kEphemerisTooOld);
  if (had_answer && 2 * without > sum(counters.satellites_by_reason))
    reasons_.raise(HealthReason::kWithoutOrbit);

  const std::int64_t precise = counters.satellites_by_source[1].get();
  most_precise_ = std::max(most_precise_, precise);
  if (most_precise_ >= kFewPrecise && precise == 0 && counters.satellites_by_source[0].get() > 0)
    reasons_.raise(HealthReason::kPreciseEnded);

  if (counters.orbits_refused.get() > 0) reasons_.raise(HealthReason::kOrbitsRefused);

  measurements_.look(counters.measurements.get());
  contradicting_.look(counters.contradicting_measurements.get());
  if (measurements_.get() >= kFewMeasurements && 2 * contradicting_.get() > measurements_.get())
    reasons_.raise(HealthReason::kMostRejected);

  detail_.clear();
  for (const System system : kSystems) {
    if (counters.lasting_cm[index_of(system)].get() >= kLastingError_cm)
      append(to_string(system), &detail_);
  }
  if (!detail_.empty()) reasons_.raise(HealthReason::kLastingErrors, detail_);

  satellite_faults_.look(events(EventKind::kSatelliteFault));
  if (satellite_faults_.get() >= kSeveralSatellites) reasons_.raise(HealthReason::kSatellitesDrift);
}

void HealthMonitor::judge_starts() {
  const std::int64_t starts = events(EventKind::kFilterReset);
  if (starts != starts_) {
    const EngineCounters& counters = engine_->counters();
    epochs_at_start_ = counters.accepted_epochs.get();
    received_at_start_ = counters.received[index_of(Channel::kGnssEpoch)].get();
  }
  starts_ = starts;
  raise_if_grown(HealthReason::kFilterStartedOver, starts);
}

void HealthMonitor::judge_estimator() {
  // While it begins, the solution jumps to where it belongs.
  const auto source = static_cast<Source>(engine_->counters().source.get());
  const bool answers = source == Source::kEkf || source == Source::kSmoother;
  answering_looks_ = answers ? answering_looks_ + 1 : 0;
  raise_if_grown(HealthReason::kSolutionJumped, engine_->counters().large_jumps.get(),
                 answering_looks_ > kSettledLooks);
  raise_if_grown(HealthReason::kPredictionWidened, engine_->counters().widened_predictions.get());
  raise_if_grown(HealthReason::kImprobable, events(EventKind::kImprobable));
  raise_if_grown(HealthReason::kConstraintsLeftOut, events(EventKind::kConstraintsLeftOut));
}

void HealthMonitor::judge_time() {
  EngineCounters& counters = engine_->counters();
  raise_if_grown(HealthReason::kDeadlineMissed, counters.misses.get());
  raise_if_grown(HealthReason::kSmootherLate, counters.smoother_misses.get());
  raise_if_grown(HealthReason::kSmootherFailed, counters.smoother_failures.get());
  raise_if_grown(HealthReason::kKeyframesSkipped, counters.keyframes_skipped.get());
  const std::uint64_t waits =
      engine_->inertial_ring().waits + engine_->gnss_ring().waits + engine_->out_ring().waits;
  raise_if_grown(HealthReason::kQueueFull, static_cast<std::int64_t>(waits));
}

// Messages that are refused are no silence.
Fault HealthMonitor::why_no_answer() const {
  const bool is_silent = (any_imu_.is_late && expects_imu_) || any_gnss_.is_late;
  return is_silent ? Fault::kSilence : Fault::kNavigation;
}

// The navigation needs no journal: what is missing in it is said, and the next piece may be whole.
void HealthMonitor::judge_disk(double now_s) {
  journal_.look(engine_->journal(), now_s);
  const auto tell = [&](JournalTrouble trouble, HealthReason reason) {
    if (journal_.has(trouble)) reasons_.raise(reason);
  };
  if (journal_.has(JournalTrouble::kFails))
    reasons_.raise(HealthReason::kJournalFails, journal_.last_failure());
  tell(JournalTrouble::kStalls, HealthReason::kJournalStalled);
  tell(JournalTrouble::kLoses, HealthReason::kJournalLost);
  tell(JournalTrouble::kLeavesOut, HealthReason::kJournalLeftOut);
  tell(JournalTrouble::kUnsynced, HealthReason::kJournalUnsynced);
  const std::string no_checkpoint = engine_->checkpoint_error();
  if (!no_checkpoint.empty()) reasons_.raise(HealthReason::kNoCheckpoint, no_checkpoint);
}

// Raised where the count has grown since the last look.
void HealthMonitor::raise_if_grown(HealthReason reason, std::int64_t count, bool counts) {
  std::int64_t& last = last_counts_[static_cast<std::size_t>(reason)];
  if (count > last && counts) reasons_.raise(reason);
  last = count;
}

std::int64_t HealthMonitor::events(EventKind kind) const {
  return engine_->counters().events[static_cast<std::size_t>(kind)].get();
}

}  // namespace leonav
