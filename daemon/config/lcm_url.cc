#include "daemon/config/lcm_url.h"

#include <arpa/inet.h>
#include <netinet/in.h>

#include <charconv>
#include <string_view>

namespace leonav {

std::optional<UdpmAddress> udpm_address(const std::string& url) {
  constexpr std::string_view kUdpm = "udpm://";
  if (!url.starts_with(kUdpm)) return std::nullopt;
  UdpmAddress address{url.substr(kUdpm.size(), url.find('?') - kUdpm.size()), 7667};
  if (const auto colon = address.group.find(':'); colon != std::string::npos) {
    const std::string digits = address.group.substr(colon + 1);
    std::from_chars(digits.data(), digits.data() + digits.size(), address.port);
    address.group.resize(colon);
  }
  if (address.group.empty()) address.group = "239.255.76.67";
  return address;
}

bool is_multicast(const std::string& group) {
  in_addr address{};
  return inet_pton(AF_INET, group.c_str(), &address) == 1 && IN_MULTICAST(ntohl(address.s_addr));
}

}  // namespace leonav
