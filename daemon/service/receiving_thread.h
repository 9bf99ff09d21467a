// The ReceivingThread is the thread `io`, which takes the messages of LCM.
#pragma once
#include <atomic>
#include <string>

#include "daemon/config/daemon_config.h"
#include "daemon/engine/engine.h"
#include "daemon/service/lcm_link.h"
#include "daemon/threads/realtime_thread.h"

namespace leonav {

class ReceivingThread {
 public:
  ReceivingThread(LcmReceiver* receiver, Engine* engine) : receiver_(receiver), engine_(engine) {}
  ~ReceivingThread() { stop(); }
  ReceivingThread(const ReceivingThread&) = delete;
  ReceivingThread& operator=(const ReceivingThread&) = delete;

  // Throws and returns as RealtimeThread::start().
  std::string start(const ThreadConfig& config);
  // Waits until the message that is received has been passed on.
  void stop();
  // The link broke, and the thread has ended.
  bool has_failed() const { return failed_.load(); }

 private:
  void receive();

  LcmReceiver* receiver_;
  Engine* engine_;
  std::atomic<bool> stop_{false}, failed_{false};
  RealtimeThread thread_;
};

}  // namespace leonav
