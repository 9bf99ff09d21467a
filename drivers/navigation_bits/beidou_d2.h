// This unit decodes BeiDou D2 (geostationary satellites): subframe 1, pages 1 to 10, gives an
// Ephemeris. Source: BDS-SIS-ICD-B1I 3.0, section 5.3 (figures 5-14-1 to 5-14-10).
#pragma once
#include <array>

#include "drivers/navigation_bits/beidou_subframe.h"
#include "drivers/navigation_bits/navigation_frame.h"

namespace leonav {

// The decoder collects the pages of one satellite.
class BeidouD2 {
 public:
  SubframeStatus add(std::span<const std::uint32_t, kBeidouWords> words,
                     const SubframeOrigin& origin, NavigationUpdate* update);

 private:
  static constexpr std::size_t kPages = 10;
  struct Part {
    BeidouSubframe subframe;
    GpsTime sent;  // unset: not received yet
  };

  bool is_complete() const;
  Ephemeris decode(const SubframeOrigin& origin) const;

  std::array<Part, kPages> parts_;
};

}  // namespace leonav
