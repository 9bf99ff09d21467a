// This unit reads RAWIMU (268), RAWIMUS (325), RAWIMUX (1461) and RAWIMUSX (1462), counts of an
// inertial sensor. Source: OEM7 manual, chapters of these names.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "core/base/gps_time.h"
#include "drivers/oem7/imu_scale.h"

namespace leonav {

// Increments over the interval that ends at `time`, in axes forward, right, down.
//
// The receiver gives them in the axes of the IMU: x to the right, y forward, z up, where the IMU is
// mounted as its housing shows; it writes y with the opposite sign. Specific force: at rest about
// -9.8 m/s^2 times the interval along down.
struct RawImuIncrements {
  using Vector = std::array<double, 3>;
  GpsTime time;
  Vector delta_theta_rad{};
  Vector delta_velocity_m_s{};
};

// Counts of messages.
struct RawImuCounters {
  std::uint64_t samples = 0;
  std::uint64_t bad_length = 0;
  std::uint64_t bad_time = 0;       // the receiver does not know the time, or it is impossible
  std::uint64_t sensor_errors = 0;  // the IMU marks its data as wrong
  std::uint64_t encrypted = 0;      // the receiver marks its data as encrypted
  std::uint64_t unknown_scale = 0;  // of a type without a documented scale, or of none
  std::optional<std::uint32_t> type_without_scale;  // the last such type; empty: no type is known
};

// The type is in RAWIMUX and RAWIMUSX; for RAWIMU and RAWIMUS it is the last one that those, or
// INSCONFIG, told.
class RawImuReader {
 public:
  // `scale`: of every IMU, instead of that of its type.
  explicit RawImuReader(std::optional<ImuScale> scale) : scale_(scale) {}

  static bool is_raw_imu(std::uint16_t message_id);
  // Precondition: is_raw_imu(message_id).
  std::optional<RawImuIncrements> read(std::uint16_t message_id,
                                       std::span<const std::uint8_t> payload);
  // Takes the payload of INSCONFIG (1945), which begins with the type.
  void take_insconfig(std::span<const std::uint8_t> payload);
  const RawImuCounters& counters() const { return counters_; }

 private:
  std::optional<ImuScale> find_scale();

  std::optional<ImuScale> scale_;
  std::optional<std::uint32_t> type_;
  RawImuCounters counters_;
};

}  // namespace leonav
