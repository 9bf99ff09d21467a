#include "daemon/engine/internal/smoother_worker.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace leonav {
namespace {

constexpr std::size_t kKeyframeRing = 4;  // each is 0.5 MB
constexpr std::size_t kOutBytes = 128 << 10;

}  // namespace

SmootherWorker::SmootherWorker(const NavigatorConfig& config, Wakeup* out, EngineCounters* counters,
                               std::function<void(std::uint64_t epoch)> before_iteration)
    : inertial_(config.motion == MotionModel::kInertial),
      time_limit_ns_(static_cast<std::int64_t>(std::llround(config.smoother.time_limit_s * 1e9))),
      counters_(counters),
      before_iteration_(std::move(before_iteration)),
      ring_(kKeyframeRing, &wakeup_),
      sink_(kOutBytes, out, counters),
      stage_(config, &mailbox_, &sink_) {}

std::string SmootherWorker::start(const ThreadConfig& config) {
  if (!inertial_) return {};
  return thread_.start(
      "smoother", config, [this] { run(); }, RealtimeThread::kEstimatorStackBytes);
}

void SmootherWorker::finish() {
  no_more_.store(true, std::memory_order_release);
  wakeup_.notify();
  thread_.join();
}

KeyframeInput* SmootherWorker::next_keyframe(std::uint64_t) { return ring_.next(); }

void SmootherWorker::push_keyframe() {
  ring_.push();
  if (!inertial_) ring_.consume_one([this](const KeyframeInput& keyframe) { process(keyframe); });
}

void SmootherWorker::no_keyframe(const Solution& filter, bool due) {
  stage_.process_non_keyframe(filter, due);
}

bool SmootherWorker::result_of(std::uint64_t epoch, SmootherAnchor* result) {
  return mailbox_.read(epoch, result);
}

void SmootherWorker::run() {
  for (;;) {
    const std::uint32_t ticket = wakeup_.ticket();
    const bool last_round = no_more_.load(std::memory_order_acquire);
    while (ring_.consume_one([this](const KeyframeInput& keyframe) { process(keyframe); })) {
    }
    if (last_round) return;
    wakeup_.wait(ticket);
  }
}

void SmootherWorker::process(const KeyframeInput& keyframe) {
  epoch_ = keyframe.index;
  solve_watch_ = Stopwatch();
  if (before_iteration_) before_iteration_(epoch_);
  stage_.process(keyframe, this);
  counters_->worst_solve_ns.raise_to(solve_watch_.nanoseconds());
}

// Elapsed time ends the solve here; the journal has the number of iterations. The next
// iteration takes as long as those before it did in the mean.
bool SmootherWorker::may_iterate(int iterations_done) {
  if (inertial_ && !mailbox_.is_open(epoch_)) return false;
  const std::int64_t elapsed_ns = solve_watch_.nanoseconds();
  const std::int64_t next_ns = elapsed_ns / std::max(iterations_done, 1);
  if (inertial_ && time_limit_ns_ > 0 && elapsed_ns + next_ns > time_limit_ns_) return false;
  if (before_iteration_) before_iteration_(epoch_);
  return true;
}

}  // namespace leonav
