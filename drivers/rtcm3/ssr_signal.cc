#include "drivers/rtcm3/ssr_signal.h"

#include <span>
#include <string_view>

namespace leonav {
namespace {

// By identifier, from 0.
constexpr std::string_view kGpsSignals[] = {"1C", "1P", "1W", "1Y", "1M", "2C", "2D",
                                            "2S", "2L", "2X", "2P", "2W", "2Y", "2M",
                                            "5I", "5Q", "5X", "1S", "1L", "1X"};
constexpr std::string_view kGalileoSignals[] = {"1A", "1B", "1C", "1X", "1Z", "5I", "5Q",
                                                "5X", "7I", "7Q", "7X", "8I", "8Q", "8X",
                                                "6A", "6B", "6C", "6X", "6Z"};
constexpr std::string_view kBeidouSignals[] = {"2I", "2Q", "2X", "6I", "6Q", "6X", "7I", "7Q",
                                               "7X", "1D", "1P", "1X", "5D", "5P", "5X"};

std::span<const std::string_view> ssr_names_of(System system) {
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

std::optional<SignalCode> signal_from_ssr(System system, std::uint32_t identifier) {
  const std::span<const std::string_view> names = ssr_names_of(system);
  if (identifier >= names.size()) return std::nullopt;
  return signal_from_string(names[identifier]);
}

}  // namespace leonav
