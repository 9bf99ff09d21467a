// This unit decodes Galileo I/NAV (E1-B and E5b): word types 1 to 5 give an Ephemeris. Source:
// Galileo OS-SIS-ICD issue 2.1, 4.3 (pages and words) and 5.1 (parameters).
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "drivers/navigation_bits/navigation_frame.h"

namespace leonav {

// The decoder collects the words of one satellite; E1-B and E5b send the same ones and share it.
class GalileoInav {
 public:
  static constexpr std::size_t kWords = 8;
  // Takes one nominal page: the even part in words 0 to 3, the odd part in words 4 to 7, 120 bits
  // each.
  SubframeStatus add(std::span<const std::uint32_t, kWords> words, const SubframeOrigin& origin,
                     NavigationUpdate* update);

 private:
  using Bits = std::array<std::uint8_t, 16>;  // a word type's 128 bits
  struct Word {
    Bits bits{};
    GpsTime received;  // unset: not received yet
  };

  bool is_complete() const;
  Ephemeris decode(const SubframeOrigin& origin) const;

  std::array<Word, 5> words_;
};

}  // namespace leonav
