// This unit decodes Galileo F/NAV (E5a): page types 1 to 4 give an Ephemeris. Source: Galileo
// OS-SIS-ICD issue 2.1, 4.2 (pages) and 5.1 (parameters).
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "drivers/navigation_bits/navigation_frame.h"

namespace leonav {

// The decoder collects the pages of one satellite.
class GalileoFnav {
 public:
  static constexpr std::size_t kWords = 8;
  // Takes one page: type 6 bits, data 208, CRC 24, tail 6, left-aligned in the eight words.
  SubframeStatus add(std::span<const std::uint32_t, kWords> words, const SubframeOrigin& origin,
                     NavigationUpdate* update);

 private:
  using Bits = std::array<std::uint8_t, 32>;
  struct Page {
    Bits bits{};
    GpsTime sent;  // unset: not received yet
  };

  bool is_complete() const;
  Ephemeris decode(const SubframeOrigin& origin) const;

  std::array<Page, 4> pages_;
};

}  // namespace leonav
