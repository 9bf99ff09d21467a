// This header defines pages of navigation messages that carry corrections, as receivers give them:
// Galileo's C/NAV of E6-B (HAS) and BeiDou's PPP-B2b.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/base/gps_time.h"
#include "core/gnss/signals/satellite.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/crc24q.h"

namespace leonav {

enum class PageService : std::uint8_t { kGalileoHas, kBeidouB2b };

// One page of one satellite. The pages of both services have 486 bits behind the synchronization
// pattern: 462 of content and the CRC-24Q over them. Source: Galileo HAS SIS ICD 1.0, table 5 (the
// six bits of the tail are left out); BDS-SIS-ICD-PPP-B2b-1.0, 6.2.
struct CorrectionPage {
  static constexpr int kContentBits = 462;
  static constexpr int kBits = kContentBits + 24;

  PageService service = PageService::kGalileoHas;
  SatelliteId satellite;  // that sent it
  GpsTime received;
  std::array<std::uint8_t, (kBits + 7) / 8> bits{};  // the first bit is the highest of bits[0]

  friend bool operator==(const CorrectionPage&, const CorrectionPage&) = default;
};

// Returns whether the checksum is right.
inline bool is_intact(const CorrectionPage& page) {
  return crc24q(BitReader(page.bits), CorrectionPage::kContentBits) ==
         BitReader(page.bits).skip(CorrectionPage::kContentBits).take(24);
}

}  // namespace leonav
