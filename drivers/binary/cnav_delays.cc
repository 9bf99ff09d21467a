#include "drivers/binary/cnav_delays.h"

#include <optional>

#include "drivers/binary/bit_field.h"
#include "drivers/binary/crc24q.h"

namespace leonav {
namespace {

constexpr int kChecksumBits = 24;

bool checksum_is_good(std::span<const std::uint8_t> bits, int count) {
  BitReader tail(bits);
  const std::uint32_t sent =
      tail.skip(static_cast<std::size_t>(count - kChecksumBits)).take(kChecksumBits);
  return !tail.overrun() && crc24q(BitReader(bits), count - kChecksumBits) == sent;
}

// A delay of GPS: 13 bits of 2^-35 s; the most negative number stands for "not available".
std::optional<double> take_gps_delay(BitReader* bits) {
  constexpr std::int32_t kNotAvailable = -4096;
  const std::int32_t raw = bits->take_signed(13);
  if (raw == kNotAvailable) return std::nullopt;
  return std::ldexp(static_cast<double>(raw), -35);
}

// A delay of BeiDou: 12 bits of 2^-34 s.
double take_beidou_delay(BitReader* bits) { return bits->scaled_signed(12, -34); }

}  // namespace

CnavStatus read_gps_cnav_delays(std::span<const std::uint8_t> bits, SatelliteId satellite,
                                GpsTime received, std::vector<SignalBias>* biases) {
  constexpr std::uint32_t kPreamble = 0b1000'1011, kClockAndDelays = 30;
  BitReader reader(bits);
  if (reader.take(8) != kPreamble || !checksum_is_good(bits, 300)) return CnavStatus::kBadChecksum;
  if (reader.take(6) != satellite.number) return CnavStatus::kWrongSatellite;
  if (reader.take(6) != kClockAndDelays) return CnavStatus::kOtherType;
  reader.skip(127 - 20);  // time of week, alert flag, clock
  GpsCnavDelays delays;
  for (auto* delay :
       {&delays.tgd, &delays.isc_l1_ca, &delays.isc_l2c, &delays.isc_l5_i, &delays.isc_l5_q}) {
    *delay = take_gps_delay(&reader);
  }
  append_biases(delays, satellite, received, biases);
  return CnavStatus::kDelays;
}

CnavStatus read_bcnav1_delays(std::span<const std::uint8_t> bits, SatelliteId satellite,
                              GpsTime received, std::vector<SignalBias>* biases) {
  if (!checksum_is_good(bits, 600)) return CnavStatus::kBadChecksum;
  BitReader reader(bits);
  // Nothing but zeros has a good checksum too; the week tells it.
  if (reader.take(13) == 0) return CnavStatus::kBadChecksum;
  reader.skip(533 - 13);  // hour, issues, elements, clock
  BeidouCnavDelays delays;
  delays.b2a_pilot = take_beidou_delay(&reader);
  delays.b1c_data_minus_pilot = take_beidou_delay(&reader);
  delays.b1c_pilot = take_beidou_delay(&reader);
  append_biases(delays, satellite, received, biases);
  return CnavStatus::kDelays;
}

CnavStatus read_bcnav2_delays(std::span<const std::uint8_t> bits, SatelliteId satellite,
                              GpsTime received, std::vector<SignalBias>* biases) {
  constexpr std::uint32_t kClockAndDelays = 30;
  if (!checksum_is_good(bits, 288)) return CnavStatus::kBadChecksum;
  BitReader reader(bits);
  if (reader.take(6) != satellite.number) return CnavStatus::kWrongSatellite;
  if (reader.take(6) != kClockAndDelays) return CnavStatus::kOtherType;
  reader.skip(121 - 12);  // time, flags, clock, issue
  BeidouCnavDelays delays;
  delays.b2a_pilot = take_beidou_delay(&reader);
  delays.b2a_data_minus_pilot = take_beidou_delay(&reader);
  reader.skip(74);  // ionosphere
  delays.b1c_pilot = take_beidou_delay(&reader);
  append_biases(delays, satellite, received, biases);
  return CnavStatus::kDelays;
}

}  // namespace leonav
