#include "daemon/engine/drill.h"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdint>
#include <thread>
#include <utility>

namespace leonav {

EngineHooks drill_hooks(const DaemonConfig& config) {
  if (config.navigator.estimator != Estimator::kSmoother) return {};
  const SmootherConfig& smoother = config.navigator.smoother;
  if (smoother.drill_failure_every > 0)
    spdlog::warn("drill: the solve of the smoother fails at every {}. epoch",
                 smoother.drill_failure_every);
  const DrillConfig& drill = config.drill;
  EngineHooks hooks;
  if (drill.late_solve_every == 0) return hooks;
  spdlog::warn("drill: the smoother waits {} s at every {}. epoch", drill.late_solve_s,
               drill.late_solve_every);
  hooks.before_iteration = [drill, last = std::uint64_t{0}](std::uint64_t epoch) mutable {
    if (std::exchange(last, epoch) == epoch) return;  // not the first iteration
    if (epoch % static_cast<std::uint64_t>(drill.late_solve_every) != 0) return;
    std::this_thread::sleep_for(std::chrono::duration<double>(drill.late_solve_s));
  };
  return hooks;
}

}  // namespace leonav
