#include "daemon/health/thread_monitor.h"

namespace leonav {

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
    if (had_work && now[i].done == last_[i].done) {
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
