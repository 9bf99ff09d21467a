// This unit decodes the Reed-Solomon code that HAS messages are sent with.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace leonav {

inline constexpr std::size_t kHasPageOctets = 53;
inline constexpr std::size_t kMaxHasPages = 32;  // of a message before it is encoded

using HasPageOctets = std::array<std::uint8_t, kHasPageOctets>;

// A page as it is sent. `id` (1 to 255) is the place of its octets in the code words.
struct EncodedPage {
  std::uint8_t id = 0;
  HasPageOctets octets{};
};

// Returns the message of as many pages as it has, in its order, from that many encoded pages;
// nullopt where they are none, more than kMaxHasPages, or have numbers that no message of this
// length has: 0, one twice, or one above its length and not above kMaxHasPages.
//
// Octet i of all pages of a message is one code word of 255 octets, of which any k give the k
// octets of the message: 32 octets m, of which those beyond k are zero, and 223 of parity, the
// remainder of m(x) x^223 by g(x) = (x - a)(x - a^2) ... (x - a^223) in GF(256) with a root a of
// x^8 + x^4 + x^3 + x^2 + 1. Source: Galileo HAS SIS ICD 1.0, 6.2 and 6.3.
std::optional<std::vector<std::uint8_t>> decode_reed_solomon(std::span<const EncodedPage> pages);

}  // namespace leonav
