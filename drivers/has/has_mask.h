// This unit reads the mask of a HAS message, which says of which satellites and signals it speaks.
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"
#include "drivers/binary/bit_field.h"

namespace leonav {

// The part of one system.
struct HasSystemMask {
  System system = System::kGps;
  std::vector<SatelliteId> satellites;  // in the order of all blocks
  // By signal that the mask has, in the order of all blocks; unset: reserved.
  std::vector<std::optional<SignalCode>> signals;
  // By satellite: the lowest bit is its first signal; a signal without its bit has no biases.
  std::vector<std::uint16_t> cells;
  std::uint8_t navigation_message = 0;  // 0: GPS LNAV, Galileo I/NAV; others are reserved
};

using HasMask = std::vector<HasSystemMask>;

// Reads the mask block of a message of type 1. nullopt where it has a system that is not defined
// (the length of its issue is then unknown), or one twice. The caller checks bits->overrun().
// Source: Galileo HAS SIS ICD 1.0, 5.2.1.
std::optional<HasMask> read_has_mask(BitReader* bits);

// Returns the system of a GNSS ID: 0 GPS, 2 Galileo; others are reserved.
std::optional<System> system_from_has(std::uint32_t gnss_id);

}  // namespace leonav
