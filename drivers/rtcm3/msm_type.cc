#include "drivers/rtcm3/msm_type.h"

namespace leonav {

std::optional<MsmType> msm_type(std::uint16_t message_number) {
  constexpr int kFirst = 1070, kLast = 1139;
  if (message_number < kFirst || message_number > kLast) return std::nullopt;
  MsmType type;
  type.format = message_number % 10;
  if (type.format < 1 || type.format > 7) return std::nullopt;
  switch (message_number / 10) {
    case 107:
      type.system = System::kGps;
      break;
    case 109:
      type.system = System::kGalileo;
      break;
    case 112:
      type.system = System::kBeidou;
      break;
    default:  // 108 GLONASS, 110 SBAS, 111 QZSS, 113 NavIC
      break;
  }
  return type;
}

}  // namespace leonav
