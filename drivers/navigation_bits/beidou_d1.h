// This unit decodes BeiDou D1 (medium and inclined orbits): subframes 1 to 3 give an Ephemeris.
// Source: BDS-SIS-ICD-B1I 3.0, section 5.2 (figures 5-8 to 5-10, tables 5-5 to 5-10).
#pragma once
#include <array>

#include "drivers/navigation_bits/beidou_subframe.h"
#include "drivers/navigation_bits/navigation_frame.h"

namespace leonav {

// The decoder collects the subframes of one satellite.
class BeidouD1 {
 public:
  SubframeStatus add(std::span<const std::uint32_t, kBeidouWords> words,
                     const SubframeOrigin& origin, NavigationUpdate* update);

 private:
  struct Part {
    BeidouSubframe subframe;
    GpsTime sent;  // unset: not received yet
  };

  bool is_complete() const;
  Ephemeris decode(const SubframeOrigin& origin) const;

  std::array<Part, 3> parts_;
};

}  // namespace leonav
