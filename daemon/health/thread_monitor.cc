#include "daemon/health/thread_monitor.h"

#include <algorithm>

#include "daemon/engine/solve_time.h"

namespace leonav {

ThreadMonitor::ThreadMonitor(Engine* engine, const NavigatorConfig& config) : engine_(engine) {
  if (config.motion != MotionModel::kInertial && config.estimator == Estimator::kSmoother)
    most_looks_[1] = std::max(most_looks_[1], time_to_solve(config).limit_s);
}

std::string ThreadMonitor::stalled_threads() {
  static constexpr std::array<const char*, kThreads> kNames = {"ins", "gnss", "smoother", "out"};
  const std::array<WorkCount, kThreads> now = {engine_->inertial_work(), engine_->gnss_work(),
                                               engine_->smoother_work(), engine_->out_work()};
  const std::int64_t io_rounds = engine_->counters().io_rounds.get();
  std::string names;
  bool behind = false;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const bool had_work = last_[i].done < last_[i].pushed;
    behind = behind || had_work;
    looks_[i] = had_work && now[i].done == last_[i].done ? looks_[i] + 1 : 0;
    if (looks_[i] >= most_looks_[i]) {
      names += (names.empty() ? "" : ", ") + std::string(kNames[i]);
    }
  }
  // `io` goes round at least every 100 ms, unless it waits for room behind a stage.
  if (io_rounds == last_io_rounds_ && !behind) names = "io";
  last_ = now;
  last_io_rounds_ = io_rounds;
  return names;
}

}  // namespace leonav
