#include "drivers/binary/cnav_delays.h"

#include <initializer_list>
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

// Appends the delay of all signals of a band with these attributes.
class BiasWriter {
 public:
  BiasWriter(SatelliteId satellite, GpsTime received, std::vector<SignalBias>* biases)
      : satellite_(satellite), received_(received), biases_(biases) {}

  void add(char band, std::initializer_list<char> attributes, std::optional<double> delay_s) {
    if (!delay_s) return;
    for (const char attribute : attributes) {
      biases_->push_back({satellite_,
                          {band, attribute},
                          BiasKind::kBroadcastCode,
                          received_,
                          kSpeedOfLight * *delay_s,
                          {},
                          {}});
    }
  }

 private:
  SatelliteId satellite_;
  GpsTime received_;
  std::vector<SignalBias>* biases_;
};

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
  const auto tgd = take_gps_delay(&reader);
  // Returns TGD minus the next correction.
  const auto next = [&]() -> std::optional<double> {
    const auto isc = take_gps_delay(&reader);
    if (!tgd || !isc) return std::nullopt;
    return *tgd - *isc;
  };
  BiasWriter writer(satellite, received, biases);
  constexpr double kGamma = (77.0 / 60.0) * (77.0 / 60.0);
  writer.add('1', {'W', 'P'}, tgd);
  writer.add('2', {'W', 'P'}, tgd ? std::optional(kGamma * *tgd) : std::nullopt);
  writer.add('1', {'C'}, next());
  writer.add('2', {'S', 'L', 'X'}, next());
  const auto l5i = next(), l5q = next();
  writer.add('5', {'I'}, l5i);
  writer.add('5', {'Q'}, l5q);
  if (l5i && l5q) writer.add('5', {'X'}, (*l5i + *l5q) / 2.0);
  return CnavStatus::kDelays;
}

CnavStatus read_bcnav1_delays(std::span<const std::uint8_t> bits, SatelliteId satellite,
                              GpsTime received, std::vector<SignalBias>* biases) {
  if (!checksum_is_good(bits, 600)) return CnavStatus::kBadChecksum;
  BitReader reader(bits);
  // Nothing but zeros has a good checksum too; the week tells it.
  if (reader.take(13) == 0) return CnavStatus::kBadChecksum;
  reader.skip(533 - 13);  // hour, issues, elements, clock
  const double b2a_pilot = take_beidou_delay(&reader);
  const double b1c_data_minus_pilot = take_beidou_delay(&reader);
  const double b1c_pilot = take_beidou_delay(&reader);
  BiasWriter writer(satellite, received, biases);
  writer.add('5', {'P'}, b2a_pilot);
  writer.add('1', {'P'}, b1c_pilot);
  writer.add('1', {'D'}, b1c_pilot + b1c_data_minus_pilot);
  writer.add('1', {'X'}, b1c_pilot + b1c_data_minus_pilot / 4.0);
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
  const double b2a_pilot = take_beidou_delay(&reader);
  const double b2a_data_minus_pilot = take_beidou_delay(&reader);
  reader.skip(74);  // ionosphere
  const double b1c_pilot = take_beidou_delay(&reader);
  BiasWriter writer(satellite, received, biases);
  writer.add('5', {'P'}, b2a_pilot);
  writer.add('5', {'D'}, b2a_pilot + b2a_data_minus_pilot);
  writer.add('5', {'X'}, b2a_pilot + b2a_data_minus_pilot / 2.0);
  writer.add('1', {'P'}, b1c_pilot);
  return CnavStatus::kDelays;
}

}  // namespace leonav
