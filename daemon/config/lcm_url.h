// These functions take the address of LCM's messages out of a URL.
#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace leonav {

struct UdpmAddress {
  std::string group;  // an IPv4 address, as given or liblcm's own
  std::uint16_t port = 0;
};

// Returns where a URL "udpm://GROUP:PORT?..." sends to; nullopt: the URL is of another kind. The
// group may be anything, see is_multicast().
std::optional<UdpmAddress> udpm_address(const std::string& url);

// Returns whether the text is an IPv4 multicast address.
bool is_multicast(const std::string& group);

}  // namespace leonav
