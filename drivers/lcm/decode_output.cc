#include "drivers/lcm/decode_output.h"

#include <cmath>
#include <leonav/epoch_t.hpp>
#include <leonav/solution_t.hpp>
#include <numbers>

#include "core/base/capacity.h"
#include "drivers/lcm/convert.h"
#include "drivers/lcm/internal/read_message.h"
#include "drivers/lcm/output_schema.h"
#include "drivers/lcm/wire.h"

namespace leonav {
namespace {

using wire::all_finite;

template <typename T>
InputFault read_output(std::span<const std::uint8_t> bytes, T* message) {
  return read_message(bytes, static_cast<std::int32_t>(OutputSchema::kNewest), message);
}

bool is_within(double value, double limit) { return std::abs(value) <= limit; }

// A solution without position may have anything in its fields.
InputFault check_values(const solution_t& from) {
  const double numbers[] = {from.latitude_rad, from.longitude_rad, from.height_m};
  if (!all_finite(numbers) || !all_finite(from.v_n) || !all_finite(from.rpy_rad) ||
      !all_finite(from.sigma_p_n) || !all_finite(from.sigma_v_n) || !all_finite(from.sigma_rpy)) {
    return InputFault::kNotFinite;
  }
  constexpr double kRound = 1e-9, kHighest_m = 1e7, kFastest_m_s = 1e5, kTurn = 7.0;
  bool good = is_within(from.latitude_rad, std::numbers::pi / 2.0 + kRound) &&
              is_within(from.longitude_rad, std::numbers::pi + kRound) &&
              is_within(from.height_m, kHighest_m);
  for (int i = 0; i < 3; ++i) {
    good = good && is_within(from.v_n[i], kFastest_m_s) && is_within(from.rpy_rad[i], kTurn) &&
           from.sigma_p_n[i] >= 0.0 && from.sigma_v_n[i] >= 0.0 && from.sigma_rpy[i] >= 0.0;
  }
  return good ? InputFault::kNone : InputFault::kOutOfRange;
}

void copy(const double (&from)[3], Eigen::Vector3d* to) {
  for (int i = 0; i < 3; ++i) (*to)[i] = from[i];
}

}  // namespace

InputFault decode_output(std::span<const std::uint8_t> bytes, Solution* solution) {
  solution_t from{};
  if (const InputFault fault = read_output(bytes, &from); fault != InputFault::kNone) return fault;
  if (!wire::is_time(from.time_ns) || from.source < 0 ||
      from.source > static_cast<std::int8_t>(Source::kSmoother)) {
    return InputFault::kOutOfRange;
  }
  Solution to;
  to.sequence = static_cast<std::uint64_t>(from.sequence);
  to.time = GpsTime::from_nanoseconds(from.time_ns);
  to.source = static_cast<Source>(from.source);
  if (to.source != Source::kNone) {
    if (const InputFault fault = check_values(from); fault != InputFault::kNone) return fault;
    to.has_attitude = from.has_attitude != 0;
    copy(from.p_e, &to.p_e);
    to.latitude = from.latitude_rad;
    to.longitude = from.longitude_rad;
    to.height = from.height_m;
    copy(from.v_n, &to.v_n);
    to.roll = from.rpy_rad[0];
    to.pitch = from.rpy_rad[1];
    to.yaw = from.rpy_rad[2];
    copy(from.sigma_p_n, &to.sigma_p_n);
    copy(from.sigma_v_n, &to.sigma_v_n);
    copy(from.sigma_rpy, &to.sigma_rpy);
    to.horizontal_protection_m = from.horizontal_protection_m;
    to.vertical_protection_m = from.vertical_protection_m;
    to.heading_protection = from.heading_protection_rad;
  }
  *solution = to;
  return InputFault::kNone;
}

InputFault decode_output(std::span<const std::uint8_t> bytes, EpochInView* epoch) {
  // The generated decoder allocates what the counts claim.
  constexpr std::size_t kSecondCountOffset = wire::kFirstCountOffset + 4;
  if (bytes.size() < kSecondCountOffset + 4) return InputFault::kUndecodable;
  if (wire::read_uint32(bytes, wire::kFirstCountOffset) > kMaxSatellites ||
      wire::read_uint32(bytes, kSecondCountOffset) > kMaxMeasurements) {
    return InputFault::kTooMany;
  }
  epoch_t from{};
  if (const InputFault fault = read_output(bytes, &from); fault != InputFault::kNone) return fault;
  if (!wire::is_time(from.time_ns) || from.satellites_used < 0) return InputFault::kOutOfRange;
  epoch->time = GpsTime::from_nanoseconds(from.time_ns);
  epoch->satellites_used = from.satellites_used;
  epoch->pdop = from.pdop;
  epoch->hdop = from.hdop;
  epoch->vdop = from.vdop;
  epoch->satellites.clear();
  for (const satellite_report_t& one : from.satellites) {
    if (one.system < 0 || one.system >= static_cast<int>(kSystemCount) || one.number <= 0) continue;
    const SatelliteId id{static_cast<System>(one.system), static_cast<std::uint16_t>(one.number)};
    if (!is_valid(id)) continue;
    epoch->satellites.push_back(
        {id, static_cast<Reason>(one.reason), one.elevation_rad, one.azimuth_rad, one.cn0_dbhz});
  }
  return InputFault::kNone;
}

}  // namespace leonav
