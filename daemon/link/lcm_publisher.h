// The LcmPublisher sends messages under the configured prefix.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/config/daemon_config.h"
#include "daemon/link/open_lcm.h"
#include "daemon/messages/encoding_sink.h"

namespace leonav {

// Has an LCM instance of its own; only one thread may use it at a time.
class LcmPublisher final : public MessageTarget {
 public:
  explicit LcmPublisher(const LcmConfig& config);  // throws LcmError
  void take(Channel channel, ByteSpan bytes) override;
  // Publishes on a channel that is not one of leonavd's; `name` is without prefix.
  void publish(std::string_view name, ByteSpan bytes);

 private:
  std::unique_ptr<lcm::LCM> lcm_;
  std::string prefix_;
  std::vector<std::string> names_;
};

}  // namespace leonav
