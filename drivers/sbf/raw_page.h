// This unit takes the pages of corrections out of the words of GALRawCNAV (4024) and BDSRawB2b
// (4242). Source: mosaic-X5 and PolaRx5TR Reference Guides, chapters of these names.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>

#include "drivers/binary/correction_page.h"
#include "drivers/navigation_bits/navigation_frame.h"

namespace leonav {

inline constexpr std::size_t kGalileoPageWords = 16, kB2bFrameWords = 31;

// The words hold the bits one after the other, the first one received the highest of the first
// word. Whether a page is intact is not checked.

// Returns the page of Galileo's E6-B: the first 486 of 492 bits, whose last six are the tail.
CorrectionPage galileo_page(std::span<const std::uint32_t, kGalileoPageWords> words,
                            const SubframeOrigin& origin);

// A frame of PPP-B2b has 984 symbols behind its preamble: the number of the satellite (6 bits), 6
// reserved bits, the 486 bits of the page, and as many symbols of the code LDPC(162,81), by which
// the receiver has corrected them already. Source: BDS-SIS-ICD-PPP-B2b-1.0, 6.1 and 6.2.
struct B2bFrame {
  std::uint32_t satellite_number = 0;
  CorrectionPage page;
};
B2bFrame b2b_frame(std::span<const std::uint32_t, kB2bFrameWords> words,
                   const SubframeOrigin& origin);

}  // namespace leonav
