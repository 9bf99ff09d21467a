// This unit decodes GPS LNAV: subframes 1 to 3 give an Ephemeris, subframe 4 page 18 a
// KlobucharModel. Source: IS-GPS-200N, 20.3.3 (figures 20-1, tables 20-I to 20-III) and 20.3.5
// (parity).
#pragma once
#include <array>
#include <cstdint>
#include <span>

#include "drivers/binary/gps_lnav_data.h"
#include "drivers/navigation_bits/navigation_frame.h"

namespace leonav {

// The decoder collects the subframes of one satellite.
class GpsLnav {
 public:
  static constexpr std::size_t kWords = 10;
  // Takes one subframe: ten words. u-blox inverts a whole word with its two leading bits (D29*,
  // D30* of the word before) and its parity, so that the data bits are not inverted.
  SubframeStatus add(std::span<const std::uint32_t, kWords> words, const SubframeOrigin& origin,
                     NavigationUpdate* update);

 private:
  struct Subframe {
    GpsLnavBits bits{};
    GpsTime sent;  // unset: not received yet
  };

  bool is_complete() const;
  Ephemeris decode(const SubframeOrigin& origin) const;

  std::array<Subframe, 3> subframes_;
};

// Returns whether the parity of all ten words is right. A word inverted together with its D29* and
// D30* satisfies the same equations, so each word is checked by itself.
bool gps_parity_is_good(std::span<const std::uint32_t, GpsLnav::kWords> words);

}  // namespace leonav
