#include "daemon/link/channel_lock.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

#include "daemon/config/lcm_url.h"
#include "daemon/link/open_lcm.h"

namespace leonav {
namespace {

struct AbstractAddress {
  sockaddr_un address{};
  socklen_t size = 0;
};

AbstractAddress abstract_address(const std::string& name) {
  AbstractAddress result;
  result.address.sun_family = AF_UNIX;
  // sun_path[0] stays 0, which makes the name abstract.
  const std::size_t length = std::min(name.size(), sizeof result.address.sun_path - 1);
  std::memcpy(result.address.sun_path + 1, name.data(), length);
  result.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + length);
  return result;
}

// Returns the process that listens there, as " (process 123)"; "" where it is not told.
std::string holder(const AbstractAddress& at) {
  const int descriptor = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor < 0) return "";
  ucred peer{};
  socklen_t size = sizeof peer;
  const bool known =
      connect(descriptor, reinterpret_cast<const sockaddr*>(&at.address), at.size) == 0 &&
      getsockopt(descriptor, SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0 && peer.pid > 0;
  close(descriptor);
  return known ? " (process " + std::to_string(peer.pid) + ")" : "";
}

}  // namespace

ChannelLock::ChannelLock(const LcmConfig& config) {
  const auto to = udpm_address(config.url);
  if (!to) return;
  const AbstractAddress at = abstract_address("leonavd/" + to->group + ":" +
                                              std::to_string(to->port) + "/" + config.prefix);
  descriptor_ = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (descriptor_ < 0) throw LcmError(std::string("no Unix socket: ") + std::strerror(errno));
  if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&at.address), at.size) != 0) {
    const int error = errno;
    close(descriptor_);
    if (error != EADDRINUSE)
      throw LcmError(std::string("the channels cannot be locked: ") + std::strerror(error));
    throw LcmError("another leonavd" + holder(at) + " answers on channels " + config.prefix +
                   "* of " + config.url + "; stop it, or set another lcm.prefix or lcm.url");
  }
  listen(descriptor_, 1);  // so that holder() can ask who listens
}

ChannelLock::~ChannelLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

void ChannelLock::let_ask() const {
  if (descriptor_ < 0) return;
  for (int one = 0; (one = accept4(descriptor_, nullptr, nullptr, SOCK_CLOEXEC)) >= 0;) close(one);
}

}  // namespace leonav
