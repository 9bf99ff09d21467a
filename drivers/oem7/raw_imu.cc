#include "drivers/oem7/raw_imu.h"

#include "core/base/calendar.h"
#include "drivers/binary/little_endian.h"

namespace leonav {
namespace {

constexpr std::uint16_t kRawimu = 268, kRawimus = 325, kRawimux = 1461, kRawimusx = 1462;
constexpr std::uint8_t kSensorError = 1, kEncrypted = 2;

// Both layouts begin with four bytes that hold the week: the short one nothing else, the extended
// one information, type and a week of two bytes.
constexpr std::size_t kSeconds = 4, kCounts = 16, kSize = 40;

GpsTime time_of(std::uint32_t week, double tow_s) {
  if (week < 1 || week > kLastGpsWeek) return {};
  if (!(tow_s >= 0.0 && tow_s < static_cast<double>(kSecondsPerWeek))) return {};
  return GpsTime::from_week_and_tow(static_cast<int>(week), tow_s);
}

// Turns z, -y, x of the sensor's axes (right, forward, up) into forward, right, down.
RawImuIncrements::Vector vector_at(const std::uint8_t* p, double scale) {
  const auto count = [p](int index) {
    return static_cast<double>(static_cast<std::int32_t>(read_u4(p + 4 * index)));
  };
  const double up = count(0), backward = count(1), right = count(2);
  return {-backward * scale, right * scale, -up * scale};
}

}  // namespace

bool RawImuReader::is_raw_imu(std::uint16_t id) {
  return id == kRawimu || id == kRawimus || id == kRawimux || id == kRawimusx;
}

void RawImuReader::take_insconfig(std::span<const std::uint8_t> payload) {
  if (payload.size() >= 4) type_ = read_u4(payload.data());
}

std::optional<ImuScale> RawImuReader::find_scale() {
  if (scale_) return scale_;
  const std::optional<ImuScale> scale = type_ ? documented_imu_scale(*type_) : std::nullopt;
  if (!scale) {
    ++counters_.unknown_scale;
    counters_.type_without_scale = type_;
  }
  return scale;
}

std::optional<RawImuIncrements> RawImuReader::read(std::uint16_t message_id,
                                                   std::span<const std::uint8_t> payload) {
  const bool is_extended = message_id == kRawimux || message_id == kRawimusx;
  const std::uint8_t* p = payload.data();
  if (payload.size() < kSize) {
    ++counters_.bad_length;
    return std::nullopt;
  }
  if (is_extended) {
    type_ = p[1];
    if ((p[0] & kEncrypted) != 0) {
      ++counters_.encrypted;
      return std::nullopt;
    }
    if ((p[0] & kSensorError) != 0) {
      ++counters_.sensor_errors;
      return std::nullopt;
    }
  }
  RawImuIncrements increments;
  increments.time = time_of(is_extended ? read_u2(p + 2) : read_u4(p), read_r8(p + kSeconds));
  if (!increments.time.is_set()) {
    ++counters_.bad_time;
    return std::nullopt;
  }
  const std::optional<ImuScale> scale = find_scale();
  if (!scale) return std::nullopt;
  increments.delta_velocity_m_s = vector_at(p + kCounts, scale->velocity_m_s);
  increments.delta_theta_rad = vector_at(p + kCounts + 12, scale->angle_rad);
  ++counters_.samples;
  return increments;
}

}  // namespace leonav
