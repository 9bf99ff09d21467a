#include "drivers/ubx/esf_reading.h"

#include <cstdlib>
#include <numbers>

namespace leonav {
namespace {

constexpr double kRate = std::numbers::pi / 180.0 * 0x1p-12;  // rad/s
constexpr double kForce = 0x1p-10;                            // m/s^2
constexpr double kTemperature = 1e-2;                         // degrees Celsius
constexpr unsigned kAllAxes = 0x3F;
constexpr int kNoAxis = -1;

// 0 to 2: rates about x, y, z; 3 to 5: forces along them.
int axis_of(EsfType type) {
  switch (type) {
    case EsfType::kGyroX:
      return 0;
    case EsfType::kGyroY:
      return 1;
    case EsfType::kGyroZ:
      return 2;
    case EsfType::kAccelX:
      return 3;
    case EsfType::kAccelY:
      return 4;
    case EsfType::kAccelZ:
      return 5;
    default:
      return kNoAxis;
  }
}

}  // namespace

EsfValue esf_value(std::uint32_t word, std::uint32_t type_mask) {
  // The sign is bit 23: shifted up to bit 31 and back it fills the bits above.
  const auto shifted = static_cast<std::int32_t>(word << 8);
  return {static_cast<std::uint8_t>(word >> 24 & type_mask), shifted >> 8};
}

EsfAssembly::EsfAssembly(EsfReading::Source source, std::int64_t tolerance_ns)
    : source_(source), tolerance_ns_(tolerance_ns) {}

void EsfAssembly::clear() {
  incomplete_ += present_ != 0;
  present_ = 0;
}

std::optional<EsfReading> EsfAssembly::add(const EsfValue& value, std::int64_t clock_ns) {
  const auto type = static_cast<EsfType>(value.type);
  if (type == EsfType::kTemperature) temperature_c_ = value.value * kTemperature;
  const int axis = axis_of(type);
  if (axis == kNoAxis) return std::nullopt;
  const unsigned bit = 1U << axis;
  if ((present_ & bit) != 0 ||
      (present_ != 0 && std::abs(clock_ns - reading_.clock_ns) > tolerance_ns_)) {
    clear();
  }
  if (present_ == 0) {
    reading_ = EsfReading();
    reading_.source = source_;
    reading_.clock_ns = clock_ns;
  }
  present_ |= bit;
  if (axis < 3) {
    reading_.angular_rate_rad_s[static_cast<std::size_t>(axis)] = value.value * kRate;
  } else {
    reading_.specific_force_m_s2[static_cast<std::size_t>(axis - 3)] = value.value * kForce;
  }
  if (present_ != kAllAxes) return std::nullopt;
  present_ = 0;
  reading_.temperature_c = temperature_c_;
  reading_.sent_ns = reading_.clock_ns;
  return reading_;
}

}  // namespace leonav
