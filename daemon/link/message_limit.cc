#include "daemon/link/message_limit.h"

#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <iterator>

namespace leonav {
namespace {

// -1: it is no socket.
int option(int descriptor, int name) {
  int value = 0;
  socklen_t size = sizeof value;
  return getsockopt(descriptor, SOL_SOCKET, name, &value, &size) == 0 ? value : -1;
}

std::set<int> udp_sockets() {
  std::set<int> sockets;
  std::error_code error;
  for (std::filesystem::directory_iterator entry("/proc/self/fd", error), end;
       !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    int descriptor = 0;
    if (std::from_chars(name.data(), name.data() + name.size(), descriptor).ec == std::errc() &&
        option(descriptor, SO_TYPE) == SOCK_DGRAM && option(descriptor, SO_DOMAIN) == AF_INET)
      sockets.insert(descriptor);
  }
  return sockets;
}

}  // namespace

MessageLimit::MessageLimit() : before_(udp_sockets()) {}

std::string MessageLimit::apply(const std::vector<ReceivedChannel>& channels) const {
  std::vector<sock_filter> program = datagram_filter(channels);
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  const std::set<int> now = udp_sockets();
  std::set<int> opened;
  std::set_difference(now.begin(), now.end(), before_.begin(), before_.end(),
                      std::inserter(opened, opened.end()));
  const std::string consequence =
      "messages of LCM that claim too much memory or are no inputs are not dropped: ";
  if (opened.empty()) return consequence + "its socket is not found in /proc/self/fd";
  for (const int socket : opened) {
    if (setsockopt(socket, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof filter) != 0)
      return consequence + std::strerror(errno);
  }
  return "";
}

}  // namespace leonav
