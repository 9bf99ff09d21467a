#include "drivers/b2b/b2b_signal.h"

#include <array>
#include <string_view>

namespace leonav {
namespace {

using Names = std::array<std::string_view, 16>;
constexpr Names kBeidou = {"2I", "1D", "1P", "", "5D", "5P", "", "7D",
                           "7P", "",   "",   "", "6I", "",   "", ""};
constexpr Names kGps = {"1C", "1P", "", "",   "1L", "1X", "", "2L",
                        "2X", "",   "", "5I", "5Q", "5X", "", ""};
constexpr Names kGalileo = {"",   "1B", "1C", "",   "5Q", "5I", "", "7I",
                            "7Q", "",   "",   "6C", "",   "",   "", ""};

}  // namespace

std::optional<SatelliteId> satellite_from_b2b(std::uint32_t slot) {
  const auto number = [slot](std::uint32_t before) {
    return static_cast<std::uint16_t>(slot - before);
  };
  if (slot == 0) return std::nullopt;
  if (slot <= 63) return SatelliteId{System::kBeidou, number(0)};
  if (slot <= 100) return SatelliteId{System::kGps, number(63)};
  if (slot <= 137) return SatelliteId{System::kGalileo, number(100)};
  return std::nullopt;
}

std::optional<SignalCode> signal_from_b2b(System system, std::uint32_t mode) {
  const Names* names = nullptr;
  if (system == System::kBeidou) names = &kBeidou;
  if (system == System::kGps) names = &kGps;
  if (system == System::kGalileo) names = &kGalileo;
  if (names == nullptr || mode >= names->size()) return std::nullopt;
  return signal_from_string((*names)[mode]);
}

}  // namespace leonav
