// Two daemons on the same channels.
#include "daemon/link/channel_lock.h"

#include <unistd.h>

#include <optional>

#include "daemon/link/open_lcm.h"
#include "support/catch.h"

using namespace leonav;

namespace {

std::string refusal(const LcmConfig& config) {
  try {
    const ChannelLock lock(config);
    return "";
  } catch (const LcmError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("channels are locked by address and prefix for as long as the lock lives") {
  LcmConfig config;
  config.prefix = "LOCK_TEST_" + std::to_string(getpid()) + "_";
  config.url = "udpm://239.255.76.67:7667?ttl=0";
  std::optional<ChannelLock> first(std::in_place, config);
  const std::string said = refusal(config);
  CHECK(said.find("another leonavd (process " + std::to_string(getpid()) + ")") == 0);
  CHECK(said.find("lcm.prefix") != std::string::npos);
  for (int attempt = 0; attempt < 5; ++attempt) {
    first->let_ask();
    CHECK(refusal(config) == said);
  }
  LcmConfig other = config;
  other.url += "&recv_buf_size=1000000";  // the same messages
  CHECK_FALSE(refusal(other).empty());
  other.url = "udpm://239.255.76.67:7668?ttl=0";
  CHECK(refusal(other).empty());
  other = config;
  other.prefix += "B_";
  CHECK(refusal(other).empty());
  other = config;
  other.url = "memq://";
  CHECK(refusal(other).empty());
  first.reset();
  CHECK(refusal(config).empty());
}
