// The LcmReceiver passes the messages of LCM to the engine.
#pragma once
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>

#include "daemon/config/daemon_config.h"
#include "daemon/engine/engine.h"
#include "daemon/link/open_lcm.h"

namespace leonav {

// Runs in the thread `io`, with an LCM instance of its own.
class LcmReceiver {
 public:
  LcmReceiver(const LcmConfig& config, Engine* engine);  // throws LcmError

  // Passes the messages received within `timeout_ms` to the engine. False: the link is broken.
  bool receive(int timeout_ms);

 private:
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& name);

  Engine* engine_;
  std::string prefix_;
  std::unique_ptr<lcm::LCM> lcm_;
};

}  // namespace leonav
