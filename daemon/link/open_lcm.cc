#include "daemon/link/open_lcm.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "daemon/config/lcm_url.h"

namespace leonav {

std::optional<std::string> multicast_problem(const std::string& url) {
  const auto to = udpm_address(url);
  if (!to) return std::nullopt;
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(to->port);
  if (!is_multicast(to->group)) {
    return "lcm.url '" + url + "': '" + to->group + "' is not a multicast address";
  }
  inet_pton(AF_INET, to->group.c_str(), &address.sin_addr);
  const int descriptor = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return std::nullopt;
  const bool reached =
      connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  const int error = errno;
  close(descriptor);
  if (reached) return std::nullopt;
  return "no multicast route to " + to->group + " (" + std::strerror(error) +
         "); mend it as root with: ip link set lo up multicast on && "
         "ip route add 224.0.0.0/4 dev lo";
}

std::unique_ptr<lcm::LCM> open_lcm(const std::string& url) {
  if (url.empty()) throw LcmError("the LCM URL is empty; udpm://239.255.76.67:7667?ttl=0 is usual");
  if (url.starts_with("tcpq:")) {
    throw LcmError("LCM URL '" + url +
                   "': tcpq ends the process when its server is away; use udpm:// or memq://");
  }
  if (const auto problem = multicast_problem(url)) throw LcmError(*problem);
  auto instance = std::make_unique<lcm::LCM>(url);
  if (!instance->good()) {
    throw LcmError("LCM cannot be opened at '" + url + "' (lcm.url); see the message above");
  }
  return instance;
}

}  // namespace leonav
