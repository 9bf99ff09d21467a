#include "daemon/supervision/supervisor.h"

#include <spdlog/spdlog.h>

#include "core/base/gps_time.h"
#include "daemon/threads/wall_clock.h"

namespace leonav {

Supervisor::Supervisor(Engine* engine, const DaemonConfig& config, const ServiceManager* manager,
                       const ChannelLock* channels, ConfigReload* reload)
    : engine_(engine),
      manager_(manager),
      channels_(channels),
      reload_(reload),
      health_(engine, config.navigator),
      threads_(engine, config.navigator),
      answer_(engine, config.navigator),
      checkpoint_log_(engine),
      journal_log_(config.journal.path, &engine->journal()) {}

void Supervisor::run(ProcessSignals* signals, const ReceivingThread& io) {
  while (!io.has_failed() && !wait_for_stop(signals)) look();
}

// Waits a second. True: the daemon is to stop.
bool Supervisor::wait_for_stop(ProcessSignals* signals) {
  const std::int64_t until_ns = monotonic_ns() + kNanosecondsPerSecond;
  for (;;) {
    switch (signals->wait_until(until_ns)) {
      case SignalRequest::kNone:
        return false;
      case SignalRequest::kStop:
        spdlog::info("{}: finishing", signals->name());
        return true;
      case SignalRequest::kReload:
        if (!reload_->is_under_way()) manager_->reloading();
        reload_->ask();
        if (!reload_->is_under_way()) manager_->ready();
    }
  }
}

void Supervisor::look_at_reload() {
  if (!reload_->is_under_way()) return;
  reload_->look();
  if (!reload_->is_under_way()) manager_->ready();
}

void Supervisor::look() {
  look_at_reload();
  const std::string stalled_threads = threads_.stalled_threads();
  engine_->publish(Channel::kHealth, health_.next(stalled_threads));
  const bool stands_still = answer_.stands_still();
  health_log_.look(&health_, stalled_threads, stands_still);
  checkpoint_log_.look();
  journal_log_.look(health_.journal());
  if (keep_rule_.look(health_.fault())) engine_->keep_journal();
  channels_->let_ask();
  if (stalled_threads.empty() && !stands_still) manager_->feed_watchdog();
}

}  // namespace leonav
