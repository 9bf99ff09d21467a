#include "drivers/rtcm3/ssr_reader.h"

#include <array>
#include <utility>

#include "core/base/angle.h"
#include "core/base/calendar.h"
#include "drivers/binary/bit_field.h"
#include "drivers/binary/week_time.h"
#include "drivers/rtcm3/ssr_signal.h"

namespace leonav {
namespace {

constexpr std::uint16_t kIgs = 4076;

// Seconds by DF391 and IDF004.
constexpr std::array<int, 16> kIntervals = {1,   2,   5,   10,  15,   30,   60,   120,
                                            240, 300, 600, 900, 1800, 3600, 7200, 10800};

// RTCM: six numbers for each system, and one with its phase biases.
std::optional<SsrType> rtcm_type(std::uint16_t number) {
  constexpr SsrKind kKinds[] = {SsrKind::kOrbit,    SsrKind::kClock,
                                SsrKind::kCodeBias, SsrKind::kOrbitAndClock,
                                SsrKind::kAccuracy, SsrKind::kHighRateClock};
  struct Block {
    System system;
    std::uint16_t first, phase_bias;
  };
  for (const Block& block : {Block{System::kGps, 1057, 1265}, Block{System::kGalileo, 1240, 1267},
                             Block{System::kBeidou, 1258, 1270}}) {
    if (number == block.phase_bias) return SsrType{SsrKind::kPhaseBias, block.system, false};
    if (number >= block.first && number < block.first + 6) {
      return SsrType{kKinds[number - block.first], block.system, false};
    }
  }
  return std::nullopt;
}

// IGS: subtypes 21 to 27, 61 to 67 and 101 to 107.
std::optional<SsrType> igs_type(std::uint32_t subtype) {
  constexpr SsrKind kKinds[] = {
      SsrKind::kOrbit,    SsrKind::kClock,     SsrKind::kOrbitAndClock, SsrKind::kHighRateClock,
      SsrKind::kCodeBias, SsrKind::kPhaseBias, SsrKind::kAccuracy};
  const std::uint32_t kind = subtype % 20;
  if (kind < 1 || kind > 7) return std::nullopt;
  switch (subtype / 20) {
    case 1:
      return SsrType{kKinds[kind - 1], System::kGps, true};
    case 3:
      return SsrType{kKinds[kind - 1], System::kGalileo, true};
    case 5:
      return SsrType{kKinds[kind - 1], System::kBeidou, true};
    default:  // 2 GLONASS, 4 QZSS, 6 SBAS, 10 ionosphere
      return std::nullopt;
  }
}

// Takes a value in units of 10^-7 m (or of m/s), so that each is one whole number divided once.
double take_value(BitReader* bits, int count, int unit_e7) {
  return static_cast<double>(std::int64_t{bits->take_signed(count)} * unit_e7) / 1e7;
}

SsrOrbit take_orbit(BitReader* bits, const SsrType& type) {
  SsrOrbit orbit;
  if (type.system == System::kBeidou && !type.is_igs) {
    orbit.beidou_toe = static_cast<std::uint16_t>(bits->take(10));
    orbit.issue = static_cast<std::uint16_t>(bits->take(8));
  } else {
    const bool is_long = type.system == System::kGalileo && !type.is_igs;
    orbit.issue = static_cast<std::uint16_t>(bits->take(is_long ? 10 : 8));
  }
  orbit.delta_rac_m.x() = take_value(bits, 22, 1000);
  orbit.delta_rac_m.y() = take_value(bits, 20, 4000);
  orbit.delta_rac_m.z() = take_value(bits, 20, 4000);
  orbit.delta_rate_rac.x() = take_value(bits, 21, 10);
  orbit.delta_rate_rac.y() = take_value(bits, 19, 40);
  orbit.delta_rate_rac.z() = take_value(bits, 19, 40);
  return orbit;
}

SsrClock take_clock(BitReader* bits) {
  SsrClock clock;
  clock.c0_m = take_value(bits, 22, 1000);
  clock.c1 = take_value(bits, 21, 10);
  clock.c2 = static_cast<double>(bits->take_signed(27)) * 2.0 / 1e8;
  return clock;
}

void take_biases(BitReader* bits, const SsrType& type, SsrSatellite* satellite,
                 SsrLeftOut* left_out) {
  const bool is_phase = type.kind == SsrKind::kPhaseBias;
  const std::uint32_t count = bits->take(5);
  if (is_phase) {
    satellite->yaw_rad = bits->scaled(9, -8) * kPi;
    satellite->yaw_rate = bits->scaled_signed(8, -13) * kPi;
  }
  for (std::uint32_t i = 0; i < count && !bits->overrun(); ++i) {
    SsrBias bias;
    const std::optional<SignalCode> code = signal_from_ssr(type.system, bits->take(5));
    if (is_phase) {
      bias.is_integer = bits->take(1) != 0;
      bias.wide_lane = static_cast<std::uint8_t>(bits->take(2));
      bias.discontinuities = static_cast<std::uint8_t>(bits->take(4));
      bias.bias_m = take_value(bits, 20, 1000);
    } else {
      bias.bias_m = take_value(bits, 14, 100'000);
    }
    if (!code) {
      ++left_out->signals;
      continue;
    }
    bias.code = *code;
    (is_phase ? satellite->phase_biases : satellite->code_biases).push_back(bias);
  }
}

void take_satellite(BitReader* bits, const SsrType& type, SsrSatellite* satellite,
                    SsrLeftOut* left_out) {
  satellite->satellite = {type.system, static_cast<std::uint16_t>(bits->take(6))};
  switch (type.kind) {
    case SsrKind::kOrbit:
      satellite->orbit = take_orbit(bits, type);
      break;
    case SsrKind::kClock:
      satellite->clock = take_clock(bits);
      break;
    case SsrKind::kOrbitAndClock:
      satellite->orbit = take_orbit(bits, type);
      satellite->clock = take_clock(bits);
      break;
    case SsrKind::kCodeBias:
    case SsrKind::kPhaseBias:
      take_biases(bits, type, satellite, left_out);
      break;
    case SsrKind::kAccuracy:
      satellite->accuracy_index = static_cast<std::uint8_t>(bits->take(6));
      break;
    case SsrKind::kHighRateClock:
      satellite->high_rate_clock_m = take_value(bits, 22, 1000);
      break;
  }
}

// Takes the header up to the number of satellites, which it returns. RTCM tells the frame of an
// orbit before the issue, the IGS behind the solution; RTCM's BeiDou time is BeiDou's own.
std::uint32_t take_header(BitReader* bits, SsrMessage* m, std::uint32_t* epoch_s) {
  const bool has_frame = m->kind == SsrKind::kOrbit || m->kind == SsrKind::kOrbitAndClock;
  const bool is_igs = m->service == SsrService::kIgs;
  bits->skip(is_igs ? 12 + 3 + 8 : 12);
  *epoch_s = bits->take(20);
  m->update_interval_s = kIntervals[bits->take(4)];
  m->more_follow = bits->take(1) != 0;
  if (has_frame && !is_igs) m->is_regional_frame = bits->take(1) != 0;
  m->issue = static_cast<std::uint8_t>(bits->take(4));
  m->provider = static_cast<std::uint16_t>(bits->take(16));
  m->solution = static_cast<std::uint8_t>(bits->take(4));
  if (has_frame && is_igs) m->is_regional_frame = bits->take(1) != 0;
  if (m->kind == SsrKind::kPhaseBias) {
    m->dispersive_is_consistent = bits->take(1) != 0;
    m->wide_lane_is_consistent = bits->take(1) != 0;
  }
  return bits->take(6);
}

}  // namespace

std::optional<SsrType> ssr_type(std::uint16_t message_number,
                                std::span<const std::uint8_t> message) {
  if (message_number != kIgs) return rtcm_type(message_number);
  return igs_type(BitReader(message).skip(12 + 3).take(8));
}

SsrStatus read_ssr(const SsrType& type, std::span<const std::uint8_t> message, GpsTime near,
                   SsrMessage* result, SsrLeftOut* left_out) {
  SsrMessage m;
  m.kind = type.kind;
  m.system = type.system;
  m.service = type.is_igs ? SsrService::kIgs : SsrService::kRtcm;
  BitReader bits(message);
  std::uint32_t epoch_s = 0;
  const std::uint32_t count = take_header(&bits, &m, &epoch_s);
  if (bits.overrun()) return SsrStatus::kBadLength;
  if (epoch_s >= kSecondsPerWeek) return SsrStatus::kBadTime;
  const bool is_beidou_time = type.system == System::kBeidou && !type.is_igs;
  m.time =
      nearest_instant(std::int64_t{epoch_s} - (is_beidou_time ? kBeidouMinusGpsSeconds : 0), near);
  for (std::uint32_t i = 0; i < count; ++i) {
    SsrSatellite satellite;
    take_satellite(&bits, type, &satellite, left_out);
    if (bits.overrun()) return SsrStatus::kBadLength;
    if (is_valid(satellite.satellite)) {
      m.satellites.push_back(std::move(satellite));
    } else {
      ++left_out->satellites;
    }
  }
  *result = std::move(m);
  return SsrStatus::kOk;
}

}  // namespace leonav
