// The daemon receives LCM messages with one instance and publishes with another.
#pragma once
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "daemon/config/daemon_config.h"
#include "daemon/engine/engine.h"
#include "daemon/messages/encoding_sink.h"

namespace leonav {

class LcmError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// The reason why multicast messages to `url` would be lost, with the command that mends it;
// nullopt: no reason known. Call it before liblcm, which waits for seconds and then reports little.
std::optional<std::string> multicast_problem(const std::string& url);

// Runs in the thread `out`; shares nothing with the receiver.
class LcmPublisher final : public MessageTarget {
 public:
  explicit LcmPublisher(const LcmConfig& config);  // throws LcmError
  void take(Channel channel, ByteSpan bytes) override;

 private:
  std::unique_ptr<lcm::LCM> lcm_;
  std::vector<std::string> names_;
};

// Runs in the thread `io`.
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
