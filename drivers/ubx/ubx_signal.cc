#include "drivers/ubx/ubx_signal.h"

#include <array>
#include <span>

namespace leonav {
namespace {

struct SignalName {
  std::uint8_t id;
  SignalCode code;
};

constexpr std::array<SignalName, 5> kGpsSignals = {{
    {0, {'1', 'C'}},  // L1 C/A
    {3, {'2', 'L'}},  // L2 CL
    {4, {'2', 'S'}},  // L2 CM
    {6, {'5', 'I'}},  // L5 I
    {7, {'5', 'Q'}},  // L5 Q
}};

constexpr std::array<SignalName, 9> kGalileoSignals = {{
    {0, {'1', 'C'}},   // E1 C
    {1, {'1', 'B'}},   // E1 B
    {3, {'5', 'I'}},   // E5a I
    {4, {'5', 'Q'}},   // E5a Q
    {5, {'7', 'I'}},   // E5b I
    {6, {'7', 'Q'}},   // E5b Q
    {8, {'6', 'B'}},   // E6 B
    {9, {'6', 'C'}},   // E6 C
    {10, {'6', 'A'}},  // E6 A
}};

// D1 and D2 are two messages on the same signal.
constexpr std::array<SignalName, 10> kBeidouSignals = {{
    {0, {'2', 'I'}},   // B1I D1
    {1, {'2', 'I'}},   // B1I D2
    {2, {'7', 'I'}},   // B2I D1
    {3, {'7', 'I'}},   // B2I D2
    {4, {'6', 'I'}},   // B3I D1
    {5, {'1', 'P'}},   // B1C pilot
    {6, {'1', 'D'}},   // B1C data
    {7, {'5', 'P'}},   // B2a pilot
    {8, {'5', 'D'}},   // B2a data
    {10, {'6', 'I'}},  // B3I D2
}};

std::span<const SignalName> signals_of(System system) {
  switch (system) {
    case System::kGps:
      return kGpsSignals;
    case System::kGalileo:
      return kGalileoSignals;
    case System::kBeidou:
      return kBeidouSignals;
    case System::kLeo:
      break;
  }
  return {};
}

}  // namespace

std::optional<System> system_from_ubx(std::uint8_t gnss_id) {
  switch (gnss_id) {
    case 0:
      return System::kGps;
    case 2:
      return System::kGalileo;
    case 3:
      return System::kBeidou;
    default:
      return std::nullopt;
  }
}

std::optional<SignalCode> signal_from_ubx(System system, std::uint8_t signal_id) {
  for (const SignalName& name : signals_of(system)) {
    if (name.id == signal_id) return name.code;
  }
  return std::nullopt;
}

}  // namespace leonav
