#include "drivers/has/has_mask.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace leonav {
namespace {

constexpr int kSatelliteBits = 40, kSignalBits = 16;

// RINEX codes by the index of the signal mask; empty: reserved. Source: ICD, table 20.
using SignalNames = std::array<std::string_view, kSignalBits>;
constexpr SignalNames kGps = {"1C", "",   "", "1S", "1L", "1X", "2S", "2L",
                              "2X", "2P", "", "5I", "5Q", "5X", "",   ""};
constexpr SignalNames kGalileo = {"1B", "1C", "1X", "5I", "5Q", "5X", "7I", "7Q",
                                  "7X", "8I", "8Q", "8X", "6B", "6C", "6X", ""};

HasSystemMask read_system(System system, BitReader* bits) {
  HasSystemMask mask;
  mask.system = system;
  for (std::uint16_t number = 1; number <= kSatelliteBits; ++number) {
    if (bits->take(1) != 0) mask.satellites.push_back({system, number});
  }
  const SignalNames& names = system == System::kGps ? kGps : kGalileo;
  for (const std::string_view name : names) {
    if (bits->take(1) != 0) mask.signals.push_back(signal_from_string(name));
  }
  const bool has_cells = bits->take(1) != 0;
  mask.cells.assign(mask.satellites.size(), 0xFFFF);
  if (has_cells) {
    for (std::uint16_t& cell : mask.cells) {
      cell = 0;
      for (std::size_t i = 0; i < mask.signals.size(); ++i) {
        cell = static_cast<std::uint16_t>(cell | bits->take(1) << i);
      }
    }
  }
  mask.navigation_message = static_cast<std::uint8_t>(bits->take(3));
  return mask;
}

}  // namespace

std::optional<System> system_from_has(std::uint32_t gnss_id) {
  if (gnss_id == 0) return System::kGps;
  if (gnss_id == 2) return System::kGalileo;
  return std::nullopt;
}

std::optional<HasMask> read_has_mask(BitReader* bits) {
  HasMask mask;
  const std::uint32_t systems = bits->take(4);
  for (std::uint32_t i = 0; i < systems; ++i) {
    const std::optional<System> system = system_from_has(bits->take(4));
    const bool is_there = std::any_of(mask.begin(), mask.end(), [&](const HasSystemMask& of) {
      return system && of.system == *system;
    });
    if (!system || is_there) return std::nullopt;
    mask.push_back(read_system(*system, bits));
  }
  bits->skip(6);
  return mask;
}

}  // namespace leonav
