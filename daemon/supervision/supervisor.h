// The Supervisor is the loop of `main` while the daemon runs.
#pragma once
#include <string>

#include "daemon/engine/engine.h"
#include "daemon/health/answer_monitor.h"
#include "daemon/health/health_monitor.h"
#include "daemon/health/keep_rule.h"
#include "daemon/health/thread_monitor.h"
#include "daemon/link/channel_lock.h"
#include "daemon/link/service_manager.h"
#include "daemon/process/process_signals.h"
#include "daemon/service/receiving_thread.h"
#include "daemon/supervision/checkpoint_log.h"
#include "daemon/supervision/config_reload.h"
#include "daemon/supervision/health_log.h"
#include "daemon/supervision/journal_log.h"

namespace leonav {

// Once a second it publishes HEALTH, logs what has changed, has the journal keep what led up to a
// fault, lets other daemons ask for the channels, and feeds the watchdog unless a thread hangs or
// the answer stands still.
class Supervisor {
 public:
  Supervisor(Engine* engine, const DaemonConfig& config, const ServiceManager* manager,
             const ChannelLock* channels, ConfigReload* reload);

  // Returns once a signal asks for it, or `io` has failed. SIGHUP reloads meanwhile.
  void run(ProcessSignals* signals, const ReceivingThread& io);

 private:
  bool wait_for_stop(ProcessSignals* signals);
  void look_at_reload();
  void look();

  Engine* engine_;
  const ServiceManager* manager_;
  const ChannelLock* channels_;
  ConfigReload* reload_;
  HealthMonitor health_;
  ThreadMonitor threads_;
  AnswerMonitor answer_;
  KeepRule keep_rule_;
  HealthLog health_log_;
  CheckpointLog checkpoint_log_;
  JournalLog journal_log_;
};

}  // namespace leonav
