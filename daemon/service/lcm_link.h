// The LcmReceiver passes the messages of LCM to the engine.
#pragma once
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>
#include <string_view>

#include "daemon/commands/command_gate.h"
#include "daemon/config/daemon_config.h"
#include "daemon/engine/engine.h"
#include "daemon/link/open_lcm.h"

namespace leonav {

// Runs in the thread `io`, with an LCM instance of its own.
class LcmReceiver {
 public:
  // liblcm starts a thread that takes messages from the socket; it gets the priority of `io`, for
  // which it works. With a gate, commands come on the channel SIGNED_COMMAND and through it, and
  // what comes on COMMAND is refused. Throws LcmError.
  LcmReceiver(const LcmConfig& config, const ThreadConfig& io, Engine* engine,
              CommandGate* gate = nullptr);

  // The first setting of that thread or of its socket that the system refused, as a text; empty:
  // none.
  const std::string& refused() const { return refused_; }

  // Passes the messages received within `timeout_ms` to the engine, and publishes COMMAND_NONCE
  // where it is due. False: the link is broken.
  bool receive(int timeout_ms);

 private:
  using Handler = void (*)(const lcm_recv_buf_t* buffer, const char* name, void* self);
  struct Input {
    std::string channel;  // full name
    std::uint32_t most_bytes;
    Handler handler;
  };
  lcm_subscription_t* subscribe(const LcmConfig& config, const Input& input);
  static void on_nothing(const lcm_recv_buf_t* buffer, const char* name, void* self);
  static void on_message(const lcm_recv_buf_t* buffer, const char* name, void* self);
  static void on_signed_command(const lcm_recv_buf_t* buffer, const char* name, void* self);

  Engine* engine_;
  CommandGate* gate_;
  std::string prefix_, refused_;
  std::unique_ptr<lcm::LCM> lcm_;
};

}  // namespace leonav
