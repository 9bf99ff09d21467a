#include "daemon/health/answer_monitor.h"

#include <algorithm>
#include <utility>

#include "core/navigator/interface/input_fault.h"
#include "daemon/health/internal/sign_of_life.h"
#include "daemon/health/internal/solution_interval.h"

namespace leonav {
namespace {

constexpr double kLongestPause_s = 60.0;

// Inputs of the channel that were refused for nothing but their time.
std::int64_t refused_for_time(const EngineCounters& counters, Channel channel) {
  const auto stream = std::find(kStreams.begin(), kStreams.end(), channel) - kStreams.begin();
  const auto& rejected = counters.rejected_of_stream[static_cast<std::size_t>(stream)];
  return rejected[static_cast<std::size_t>(InputFault::kTimeBackwards)].get() +
         rejected[static_cast<std::size_t>(InputFault::kTooFarAhead)].get();
}

}  // namespace

AnswerMonitor::AnswerMonitor(Engine* engine, const NavigatorConfig& config)
    : engine_(engine),
      expects_imu_(config.motion == MotionModel::kInertial),
      most_looks_(std::max(kLongestPause_s, kIntervalsTolerated * solution_interval(config))) {}

bool AnswerMonitor::stands_still() {
  EngineCounters& counters = engine_->counters();
  const std::int64_t solution_ns = counters.solution_time_ns.get();
  const auto grows = [](std::int64_t* last, std::int64_t count) {
    return std::exchange(*last, count) != count;
  };
  const bool is_new = grows(&solution_ns_, solution_ns);
  const bool uses_imu = grows(&imu_, counters.accepted_imu.get()),
             uses_epoch = grows(&epochs_, counters.accepted_epochs.get()),
             refuses_imu = grows(&refused_imu_, refused_for_time(counters, Channel::kImu)),
             refuses_epoch =
                 grows(&refused_epochs_, refused_for_time(counters, Channel::kGnssEpoch) +
                                             counters.late_epochs.get());
  const bool uses_none = !uses_imu && !uses_epoch;
  const bool has_imu = uses_imu || (uses_none && refuses_imu) || !expects_imu_;
  const bool has_epoch = uses_epoch || (uses_none && refuses_epoch);
  const bool uses_satellites =
      std::any_of(counters.satellites_used.begin(), counters.satellites_used.end(),
                  [](const Gauge& used) { return used.get() > 0; });
  seconds_without_imu_ = uses_imu ? 0 : seconds_without_imu_ + 1;
  const bool gnss_alone = !has_imu && seconds_without_imu_ > kLongestPause_s;
  if (is_new || solution_ns == 0 || !(has_imu || gnss_alone) || !uses_satellites) {
    looks_ = 0;
  } else if (gnss_alone ? uses_epoch : has_epoch) {  // a look without says nothing: epochs may come
                                                     // more rarely than looks
    ++looks_;
  }
  return looks_ >= most_looks_;
}

}  // namespace leonav
