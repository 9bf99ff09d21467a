#include "drivers/sbf/sbf_signal.h"

#include <array>

namespace leonav {
namespace {

struct NumberRange {
  std::uint8_t first, last;
  System system;
  std::uint8_t offset;  // from the number in the system
};
constexpr std::array<NumberRange, 4> kRanges = {{
    {1, 37, System::kGps, 0},
    {71, 106, System::kGalileo, 70},
    {141, 180, System::kBeidou, 140},
    {223, 245, System::kBeidou, 182},  // C41 to C63
}};

struct SignalName {
  std::uint8_t number;
  SbfSignal signal;
};

// The receiver names the component that it tracks by what RINEX calls it in its own conversion.
constexpr std::array<SignalName, 17> kSignals = {{
    {0, {System::kGps, {'1', 'C'}}},      // L1 C/A
    {1, {System::kGps, {'1', 'W'}}},      // L1 P(Y)
    {2, {System::kGps, {'2', 'W'}}},      // L2 P(Y)
    {3, {System::kGps, {'2', 'L'}}},      // L2C
    {4, {System::kGps, {'5', 'Q'}}},      // L5
    {5, {System::kGps, {'1', 'L'}}},      // L1C
    {13, {System::kBeidou, {'1', 'P'}}},  // B1C
    {14, {System::kBeidou, {'5', 'P'}}},  // B2a
    {17, {System::kGalileo, {'1', 'C'}}},
    {19, {System::kGalileo, {'6', 'C'}}},  // or B
    {20, {System::kGalileo, {'5', 'Q'}}},  // E5a
    {21, {System::kGalileo, {'7', 'Q'}}},  // E5b
    {22, {System::kGalileo, {'8', 'Q'}}},  // E5 AltBOC
    {28, {System::kBeidou, {'2', 'I'}}},   // B1I
    {29, {System::kBeidou, {'7', 'I'}}},   // B2I
    {30, {System::kBeidou, {'6', 'I'}}},   // B3I
    {34, {System::kBeidou, {'7', 'D'}}},   // B2b
}};

}  // namespace

std::optional<SatelliteId> satellite_from_sbf(std::uint8_t number) {
  for (const NumberRange& range : kRanges) {
    if (number < range.first || number > range.last) continue;
    return SatelliteId{range.system, static_cast<std::uint16_t>(number - range.offset)};
  }
  return std::nullopt;
}

std::optional<SbfSignal> signal_from_sbf(std::uint32_t number, bool e6_is_b) {
  for (const SignalName& name : kSignals) {
    if (name.number != number) continue;
    SbfSignal signal = name.signal;
    if (e6_is_b && signal.system == System::kGalileo && signal.code.band == '6') {
      signal.code.attribute = 'B';
    }
    return signal;
  }
  return std::nullopt;
}

}  // namespace leonav
