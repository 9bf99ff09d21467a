#include "drivers/transport/internal/ntrip_request.h"

#include <cstdint>

namespace leonav {
namespace {

// The address of version 6 is in brackets (RFC 3986, 3.2.2).
std::string host_field(const NtripOptions& options) {
  const bool is_v6 = options.host.find(':') != std::string::npos;
  return (is_v6 ? "[" + options.host + "]" : options.host) + ":" + std::to_string(options.port);
}

}  // namespace

std::string base64(std::string_view text) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string result;
  for (std::size_t i = 0; i < text.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < text.size() ? static_cast<unsigned char>(text[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      result += i + k > text.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63U];
    }
  }
  return result;
}

std::string ntrip_request(const NtripOptions& options, NtripVersion version,
                          const std::optional<Credentials>& credentials,
                          std::string_view position_line) {
  const bool is_2 = version == NtripVersion::k2;
  std::string text = "GET /" + options.mountpoint + (is_2 ? " HTTP/1.1\r\n" : " HTTP/1.0\r\n");
  if (is_2) text += "Host: " + host_field(options) + "\r\nNtrip-Version: Ntrip/2.0\r\n";
  text += "User-Agent: NTRIP leonav\r\nAccept: */*\r\nConnection: close\r\n";
  if (is_2 && !position_line.empty()) {
    text += "Ntrip-GGA: " + std::string(position_line) + "\r\n";
  }
  if (credentials) {
    text +=
        "Authorization: Basic " + base64(credentials->user + ":" + credentials->password) + "\r\n";
  }
  return text + "\r\n";
}

}  // namespace leonav
