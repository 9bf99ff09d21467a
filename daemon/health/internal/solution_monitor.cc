#include "daemon/health/internal/solution_monitor.h"

#include <algorithm>

#include "daemon/health/internal/counter_sums.h"
#include "daemon/health/internal/findings.h"
#include "daemon/health/internal/solution_interval.h"
#include "daemon/text/alignment_text.h"

namespace leonav {
namespace {

constexpr double kShortestSolutionGap_s = 2.0;  // a pause of `main` must not count as one
// Like the longest hole over which the inertial answer is carried.
constexpr double kAnswerLife_s = 10.0;
constexpr double kIntervalsUntilFault = 10.0;

SignOfLife answer_each(double interval_s) {
  return SignOfLife(std::max(kShortestSolutionGap_s, kIntervalsTolerated * interval_s),
                    std::max(kAnswerLife_s, kIntervalsUntilFault * interval_s));
}

}  // namespace

SolutionMonitor::SolutionMonitor(const EngineCounters* counters, const NavigatorConfig& config)
    : counters_(counters),
      alignment_(config.alignment),
      expects_imu_(config.motion == MotionModel::kInertial),
      solution_(answer_each(solution_interval(config))),
      solution_without_imu_(
          answer_each(std::max(solution_interval(config), config.realtime.epoch_interval_s))),
      levels_(config.integrity) {
  detail_.reserve(kDetailBytes);
}

// An input that ends is a fault by its consequence only: without GNSS the inertial answer goes on.
std::span<const Finding> SolutionMonitor::look(double now_s, InputMonitor* inputs,
                                               const EstimatorMonitor& estimator) {
  found_.clear();
  const auto source = static_cast<Source>(counters_->source.get());
  fault_ = inputs->is_silent() ? Fault::kSilence : Fault::kNavigation;
  if (source == Source::kNone) {
    found_.add(HealthReason::kNoSolutionYet, why_no_solution(inputs, estimator));
    return found_.get();
  }
  solution_.look(counters_->solution_time_ns.get(), now_s);
  solution_without_imu_.look(counters_->solution_time_ns.get(), now_s);
  const SignOfLife& solution = inputs->lacks_imu() ? solution_without_imu_ : solution_;
  has_ended_ = solution.has_ended();
  if (has_ended_) {  // then the last source means nothing
    found_.add(HealthReason::kSolutionEnded);
    return found_.get();
  }
  fault_ = Fault::kNone;
  if (solution.is_late()) found_.add(HealthReason::kSolutionLate);
  if (source == Source::kAligning) {
    // Between an attitude and the first answer with it nothing lacks any more.
    const AlignmentNeed need = unpack_alignment_need(counters_->alignment_need.get());
    const AlignmentText text = to_text(need, alignment_);
    found_.add(HealthReason::kAligning, inputs->lacks_imu()
                                            ? std::string_view("no IMU sample is used")
                                            : std::string_view(text.data(), text.size()));
  }
  if (source == Source::kInsOnly)
    found_.add(expects_imu_ ? HealthReason::kInsOnly : HealthReason::kPredictionOnly);
  if (const std::string_view levels = levels_.exceeded(*counters_); !levels.empty())
    found_.add(HealthReason::kLevelAboveLimit, levels);
  return found_.get();
}

Source SolutionMonitor::source() const {
  return has_ended_ ? Source::kNone : static_cast<Source>(counters_->source.get());
}

std::string_view SolutionMonitor::why_no_solution(InputMonitor* inputs,
                                                  const EstimatorMonitor& estimator) {
  const std::int64_t measured = sum(counters_->satellites_by_reason);
  const std::string_view why = inputs->why_no_epoch(estimator.heard_no_epoch());
  if (!why.empty()) return why;
  // The satellites are those of the epoch before.
  if (estimator.waits_for_epoch())
    return "the filter has started over and waits for the next GNSS epoch";
  if (measured == 0) return "the GNSS epochs are without satellites: look at the antenna";
  std::size_t most = 0;
  for (std::size_t i = 0; i < kReasonCount; ++i) {
    if (is_used(static_cast<Reason>(i)) || i == static_cast<std::size_t>(Reason::kNotSolved))
      continue;
    if (counters_->satellites_by_reason[i].get() > counters_->satellites_by_reason[most].get())
      most = i;
  }
  const auto reason = static_cast<Reason>(most);
  if (reason == Reason::kUsed || 2 * satellite_count(*counters_, reason) < measured)
    return "too few satellites with good codes so far: wait under open sky";
  if (reason == Reason::kNoEphemeris)
    return "most satellites have no ephemeris: see that they are sent";
  detail_ = "most satellites are left out as ";
  detail_ += to_string(reason);
  return detail_ += ": look at the antenna and at gnss in the configuration";
}

}  // namespace leonav
