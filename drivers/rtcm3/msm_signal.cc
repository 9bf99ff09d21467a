#include "drivers/rtcm3/msm_signal.h"

#include <array>
#include <string_view>

namespace leonav {
namespace {

constexpr std::size_t kSignals = 32;
// The codes of bits 1 to 32; empty: reserved.
using Names = std::array<std::string_view, kSignals>;

constexpr Names kGpsNames = {"",   "1C", "1P", "1W", "",   "",   "", "2C", "2P", "2W", "",
                             "",   "",   "",   "2S", "2L", "2X", "", "",   "",   "",   "5I",
                             "5Q", "5X", "",   "",   "",   "",   "", "1S", "1L", "1X"};
constexpr Names kGalileoNames = {"",   "1C", "1A", "1B", "1X", "1Z", "",   "6C", "6A", "6B", "6X",
                                 "6Z", "",   "7I", "7Q", "7X", "",   "8I", "8Q", "8X", "",   "5I",
                                 "5Q", "5X", "",   "",   "",   "",   "",   "",   "",   ""};
constexpr Names kBeidouNames = {"",   "2I", "2Q", "2X", "",   "", "", "6I", "6Q", "6X", "",
                                "",   "",   "7I", "7Q", "7X", "", "", "",   "",   "",   "5D",
                                "5P", "5X", "7D", "",   "",   "", "", "1D", "1P", "1X"};

const Names* msm_names_of(System system) {
  switch (system) {
    case System::kGps:
      return &kGpsNames;
    case System::kGalileo:
      return &kGalileoNames;
    case System::kBeidou:
      return &kBeidouNames;
    case System::kLeo:
      break;
  }
  return nullptr;
}

}  // namespace

std::optional<SignalCode> signal_from_msm(System system, std::uint8_t signal_id) {
  const Names* names = msm_names_of(system);
  if (names == nullptr || signal_id < 1 || signal_id > kSignals) return std::nullopt;
  return signal_from_string((*names)[signal_id - 1u]);
}

}  // namespace leonav
