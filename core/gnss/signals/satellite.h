// This unit defines satellite systems, satellite identities and their RINEX names.
#pragma once
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/capacity.h"

namespace leonav {

// The values are on the wire: append only.
enum class System : std::uint8_t { kGps = 0, kGalileo = 1, kBeidou = 2, kLeo = 3 };
inline constexpr std::size_t kSystemCount = 4;
inline constexpr std::array<System, kSystemCount> kSystems = {System::kGps, System::kGalileo,
                                                              System::kBeidou, System::kLeo};

// Returns the index of a system in tables by system.
constexpr std::size_t index_of(System system) { return static_cast<std::size_t>(system); }
std::string_view to_string(System system);  // "gps", "galileo", "beidou", "leo"
std::optional<System> system_from_string(std::string_view name);

// A satellite is its system and its number there (GPS PRN 1-63, Galileo 1-50, BeiDou 1-63, LEO
// 1-399).
struct SatelliteId {
  System system = System::kGps;
  std::uint16_t number = 0;
  friend constexpr auto operator<=>(const SatelliteId&, const SatelliteId&) = default;
};

// Highest number of each system.
inline constexpr std::array<std::uint16_t, kSystemCount> kHighestNumber = {63, 50, 63, 399};

// Returns whether the number is within its system's range.
bool is_valid(SatelliteId id);

// Returns the index of a valid satellite in a table that has one entry for every satellite name; it
// needs no search.
constexpr std::size_t table_index_of(SatelliteId id) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < index_of(id.system); ++i) first += kHighestNumber[i];
  return first + id.number - 1u;
}
static_assert(table_index_of({System::kLeo, kHighestNumber[3]}) + 1 == kMaxEphemerisSatellites);

// Reads a RINEX name: a letter and two digits. LEO: L01-L99 are 1-99, M00-M99 100-199, N00-N99
// 200-299, O00-O99 300-399. A blank tens digit ("G 5") is read as zero. Returns nullopt for any
// other text, including systems that leonav does not use (GLONASS, SBAS, QZSS, NavIC).
std::optional<SatelliteId> satellite_from_string(std::string_view name);
std::string to_string(SatelliteId id);

// Returns whether the satellite is a BeiDou one in geostationary orbit (C01-C05, C59-C63). Their
// broadcast orbit has a frame of its own (BDS-SIS-ICD-B1I 3.0, table 5-11) and their D2 message has
// other subframes.
bool is_beidou_geostationary(SatelliteId id);

}  // namespace leonav
