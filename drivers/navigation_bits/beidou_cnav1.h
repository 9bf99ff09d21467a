// This unit reads the elements in BeiDou's B-CNAV1, the message of B1C: its subframe 2 holds a
// whole set. Source: BDS-SIS-ICD-B1C 1.0, 6.2.2 (figures 6-6 and 6-8 to 6-10) and 7.5 to 7.7
// (tables 7-3 to 7-8).
#pragma once
#include <cstdint>
#include <optional>
#include <span>

#include "drivers/navigation_bits/navigation_frame.h"

namespace leonav {

// Reads the 600 bits of subframe 2, in order from the first byte's highest one, whose CRC-24Q the
// caller has checked. The set counts as sent at origin.now, within the 18 s of its frame. Health
// and accuracy are in subframe 3 and therefore zero; the message names no satellite.
SubframeStatus read_bcnav1_elements(std::span<const std::uint8_t> bits,
                                    const SubframeOrigin& origin, Ephemeris* ephemeris);

}  // namespace leonav
