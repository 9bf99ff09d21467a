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
  // liblcm starts a thread that takes messages from the socket; it gets the priority of `io`, for
  // which it works. Throws LcmError.
  LcmReceiver(const LcmConfig& config, const ThreadConfig& io, Engine* engine);

  // The settings of that thread that the system refused, as a text; empty: none.
  const std::string& refused() const { return refused_; }

  // Passes the messages received within `timeout_ms` to the engine. False: the link is broken.
  bool receive(int timeout_ms);

 private:
  static void on_message(const lcm_recv_buf_t* buffer, const char* name, void* self);

  Engine* engine_;
  std::string prefix_, refused_;
  std::unique_ptr<lcm::LCM> lcm_;
};

}  // namespace leonav
