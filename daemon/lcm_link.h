// The daemon's ends of LCM: one instance receives in `io`, another publishes in `out`, so that the
// two threads share nothing.
#pragma once
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/config/daemon_config.h"
#include "daemon/encoding_sink.h"
#include "daemon/engine.h"

namespace leonav {

class LcmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Why messages by multicast to `url` would go nowhere, and the command that mends it; nullopt: no
// reason known. Asked before liblcm, which waits for seconds and then says little.
std::optional<std::string> multicast_problem(const std::string& url);

class LcmPublisher final : public MessageTarget {
 public:
  explicit LcmPublisher(const LcmConfig& config);  // throws LcmError
  void take(Channel channel, ByteSpan bytes) override;

 private:
  std::unique_ptr<lcm::LCM> lcm_;
  std::vector<std::string> names_;
};

class LcmReceiver {
 public:
  LcmReceiver(const LcmConfig& config, Engine* engine);  // throws LcmError

  // Hands what comes within `timeout_ms` to the engine. False: the link is broken.
  bool receive(int timeout_ms);

 private:
  void on_message(const lcm::ReceiveBuffer* buffer, const std::string& name);

  Engine* engine_;
  std::string prefix_;
  std::unique_ptr<lcm::LCM> lcm_;
};

}  // namespace leonav
