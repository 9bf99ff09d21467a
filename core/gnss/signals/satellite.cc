#include "core/gnss/signals/satellite.h"

namespace leonav {
namespace {

constexpr std::array<std::string_view, kSystemCount> kSystemNames = {"gps", "galileo", "beidou",
                                                                     "leo"};
// The names of LEO satellites continue through these letters: L01 is 1, M00 is 100.
constexpr std::string_view kLeoLetters = "LMNO";

}  // namespace

std::string_view to_string(System system) {
  const std::size_t index = index_of(system);
  return index < kSystemCount ? kSystemNames[index] : std::string_view("unknown");
}

std::optional<System> system_from_string(std::string_view name) {
  for (const System system : kSystems) {
    if (name == kSystemNames[index_of(system)]) return system;
  }
  return std::nullopt;
}

bool is_valid(SatelliteId id) {
  const std::size_t index = index_of(id.system);
  return index < kSystemCount && id.number >= 1 && id.number <= kHighestNumber[index];
}

std::optional<SatelliteId> satellite_from_string(std::string_view name) {
  if (name.size() != 3) return std::nullopt;
  const char tens = name[1] == ' ' ? '0' : name[1];
  const char ones = name[2];
  if (tens < '0' || tens > '9' || ones < '0' || ones > '9') return std::nullopt;

  SatelliteId id;
  int number = 10 * (tens - '0') + (ones - '0');
  switch (name[0]) {
    case 'G':
      id.system = System::kGps;
      break;
    case 'E':
      id.system = System::kGalileo;
      break;
    case 'C':
      id.system = System::kBeidou;
      break;
    default: {
      const std::size_t hundreds = kLeoLetters.find(name[0]);
      if (hundreds == std::string_view::npos) return std::nullopt;
      id.system = System::kLeo;
      number += 100 * static_cast<int>(hundreds);
    }
  }
  id.number = static_cast<std::uint16_t>(number);
  if (!is_valid(id)) return std::nullopt;
  return id;
}

std::string to_string(SatelliteId id) {
  if (!is_valid(id)) return "???";
  char letter = 'G';
  if (id.system == System::kGalileo) letter = 'E';
  if (id.system == System::kBeidou) letter = 'C';
  if (id.system == System::kLeo) letter = kLeoLetters[id.number / 100];
  const int rest = id.number % 100;
  return {letter, static_cast<char>('0' + rest / 10), static_cast<char>('0' + rest % 10)};
}

bool is_beidou_geostationary(SatelliteId id) {
  return id.system == System::kBeidou &&
         ((id.number >= 1 && id.number <= 5) || (id.number >= 59 && id.number <= 63));
}

}  // namespace leonav
