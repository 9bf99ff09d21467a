#include "daemon/health/answer_monitor.h"

#include <utility>

namespace leonav {

bool AnswerMonitor::stands_still(bool expects_imu) {
  EngineCounters& counters = engine_->counters();
  const std::int64_t solution_ns = counters.solution_time_ns.get();
  if (std::exchange(solution_ns_, solution_ns) != solution_ns || solution_ns == 0) looks_ = 0;
  const std::int64_t imu = counters.accepted_imu.get(), epochs = counters.accepted_epochs.get();
  const bool has_imu = std::exchange(imu_, imu) != imu || !expects_imu;
  const bool has_epoch = std::exchange(epochs_, epochs) != epochs;
  bool uses_satellites = false;
  for (const Gauge& used : counters.satellites_used)
    uses_satellites = uses_satellites || used.get() > 0;
  // A look without an epoch says nothing: they may come more rarely than once a second.
  if (solution_ns == 0 || !has_imu || !uses_satellites) looks_ = 0;
  if (solution_ns != 0 && has_imu && has_epoch && uses_satellites) ++looks_;
  return looks_ >= kMostLooks;
}

}  // namespace leonav
