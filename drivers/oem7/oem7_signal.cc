#include "drivers/oem7/oem7_signal.h"

#include <array>
#include <span>

namespace leonav {
namespace {

struct SignalName {
  std::uint8_t number;
  SignalCode code;
};

// Of the tracking status. The receiver names the component that it tracks, and so does the code.
constexpr std::array<SignalName, 6> kGps = {{
    {0, {'1', 'C'}},   // L1 C/A
    {5, {'2', 'P'}},   // L2 P
    {9, {'2', 'W'}},   // L2 P(Y), semi-codeless
    {14, {'5', 'Q'}},  // L5 Q
    {16, {'1', 'L'}},  // L1C pilot
    {17, {'2', 'S'}},  // L2C M
}};
constexpr std::array<SignalName, 6> kGalileo = {{
    {2, {'1', 'C'}},   // E1 C
    {6, {'6', 'B'}},   // E6 B
    {7, {'6', 'C'}},   // E6 C
    {12, {'5', 'Q'}},  // E5a Q
    {17, {'7', 'Q'}},  // E5b Q
    {20, {'8', 'Q'}},  // E5 AltBOC Q
}};
// D1 and D2 are two messages on the same signal.
constexpr std::array<SignalName, 9> kBeidou = {{
    {0, {'2', 'I'}},   // B1I D1
    {1, {'7', 'I'}},   // B2I D1
    {2, {'6', 'I'}},   // B3I D1
    {4, {'2', 'I'}},   // B1I D2
    {5, {'7', 'I'}},   // B2I D2
    {6, {'6', 'I'}},   // B3I D2
    {7, {'1', 'P'}},   // B1C pilot
    {9, {'5', 'P'}},   // B2a pilot
    {11, {'7', 'D'}},  // B2b I
}};

// Of RANGECMP2 and RANGECMP4.
constexpr std::array<SignalName, 6> kCompressedGps = {{
    {1, {'1', 'C'}},
    {4, {'2', 'W'}},
    {5, {'2', 'S'}},
    {6, {'2', 'P'}},
    {7, {'5', 'Q'}},
    {15, {'1', 'L'}},
}};
constexpr std::array<SignalName, 6> kCompressedGalileo = {{
    {1, {'1', 'C'}},
    {2, {'5', 'Q'}},
    {3, {'7', 'Q'}},
    {4, {'8', 'Q'}},
    {5, {'6', 'C'}},
    {12, {'6', 'B'}},
}};
constexpr std::array<SignalName, 9> kBeidouOfRangecmp2 = {{
    {1, {'2', 'I'}},
    {2, {'2', 'I'}},
    {3, {'7', 'I'}},
    {4, {'7', 'I'}},
    {13, {'6', 'I'}},
    {16, {'6', 'I'}},
    {19, {'1', 'P'}},
    {20, {'5', 'P'}},
    {21, {'7', 'D'}},
}};
constexpr std::array<SignalName, 9> kBeidouOfRangecmp4 = {{
    {1, {'2', 'I'}},
    {2, {'2', 'I'}},
    {3, {'7', 'I'}},
    {4, {'7', 'I'}},
    {5, {'6', 'I'}},
    {6, {'6', 'I'}},
    {7, {'1', 'P'}},
    {9, {'5', 'P'}},
    {11, {'7', 'D'}},
}};

std::optional<SignalCode> find(std::span<const SignalName> names, std::uint32_t number) {
  for (const SignalName& name : names) {
    if (name.number == number) return name.code;
  }
  return std::nullopt;
}

// Returns the code from one of three tables.
std::optional<SignalCode> find(System system, std::uint32_t number, std::span<const SignalName> gps,
                               std::span<const SignalName> galileo,
                               std::span<const SignalName> beidou) {
  switch (system) {
    case System::kGps:
      return find(gps, number);
    case System::kGalileo:
      return find(galileo, number);
    case System::kBeidou:
      return find(beidou, number);
    case System::kLeo:
      break;
  }
  return std::nullopt;
}

}  // namespace

std::optional<System> TrackingStatus::system() const {
  switch ((word_ >> 16) & 7u) {
    case 0:
      return System::kGps;
    case 3:
      return System::kGalileo;
    case 4:
      return System::kBeidou;
    default:
      return std::nullopt;
  }
}

std::optional<SignalCode> TrackingStatus::signal() const {
  return find(*system(), (word_ >> 21) & 0x1Fu, kGps, kGalileo, kBeidou);
}

std::optional<System> system_from_compressed(std::uint32_t number) {
  switch (number) {
    case 0:
      return System::kGps;
    case 5:
      return System::kGalileo;
    case 6:
      return System::kBeidou;
    default:
      return std::nullopt;
  }
}

std::optional<SignalCode> signal_from_rangecmp2(System system, std::uint32_t number) {
  return find(system, number, kCompressedGps, kCompressedGalileo, kBeidouOfRangecmp2);
}

std::optional<SignalCode> signal_from_rangecmp4(System system, std::uint32_t number) {
  return find(system, number, kCompressedGps, kCompressedGalileo, kBeidouOfRangecmp4);
}

}  // namespace leonav
