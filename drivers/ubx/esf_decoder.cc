#include "drivers/ubx/esf_decoder.h"

#include <vector>

#include "drivers/binary/little_endian.h"

namespace leonav {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
// 39.0625 us are 78,125 / 2 ns: an even number of ticks is a whole number of nanoseconds.
constexpr std::int64_t kTwoTicks_ns = 78'125;
// Values of one sample have tags that differ by less; the fastest sensor takes one each 5 ms or so.
constexpr std::int64_t kTolerance_ns = 2 * kMillisecond_ns;

constexpr std::size_t kMeasHeader = 8, kMeasValue = 4, kCalibrated = 4;
constexpr std::uint16_t kHasCalibrated = 1 << 3;
constexpr std::size_t kRawHeader = 4, kRawValue = 8;

}  // namespace

EsfDecoder::EsfDecoder()
    : meas_(EsfReading::Source::kMeas, kTolerance_ns),
      raw_(EsfReading::Source::kRaw, kTolerance_ns) {}

void EsfDecoder::add(EsfAssembly* assembly, const EsfValue& value, std::int64_t clock_ns,
                     const Take& take) {
  switch (static_cast<EsfType>(value.type)) {
    case EsfType::kGyroX:
    case EsfType::kGyroY:
    case EsfType::kGyroZ:
    case EsfType::kTemperature:
    case EsfType::kAccelX:
    case EsfType::kAccelY:
    case EsfType::kAccelZ:
      break;
    default:
      ++counters_.other_values;
      return;
  }
  if (const auto reading = assembly->add(value, clock_ns)) {
    ++counters_.readings;
    take(*reading);
  }
}

void EsfDecoder::decode_meas(std::span<const std::uint8_t> payload, const Take& take) {
  if (payload.size() < kMeasHeader) {
    ++counters_.bad_length;
    return;
  }
  const std::uint8_t* p = payload.data();
  const std::uint16_t flags = read_u2(p + 4);
  const std::size_t values = flags >> 11;
  const bool has_calibrated = (flags & kHasCalibrated) != 0;
  const std::size_t end = kMeasHeader + values * kMeasValue;
  if (payload.size() != end + (has_calibrated ? kCalibrated : 0)) {
    ++counters_.bad_length;
    return;
  }
  if (has_raw_) {
    ++counters_.superseded;
    return;
  }
  const std::uint32_t tag_ms = read_u4(has_calibrated ? p + end : p);
  const std::int64_t clock_ns = milliseconds_.extend(tag_ms) * kMillisecond_ns;
  for (std::size_t at = kMeasHeader; at < end; at += kMeasValue) {
    add(&meas_, esf_value(read_u4(p + at), 0x3F), clock_ns, take);
  }
}

void EsfDecoder::decode_raw(std::span<const std::uint8_t> payload, const Take& take) {
  if (payload.size() < kRawHeader || (payload.size() - kRawHeader) % kRawValue != 0) {
    ++counters_.bad_length;
    return;
  }
  if (!has_raw_) {
    has_raw_ = true;
    meas_.clear();
  }
  raw_.clear();  // samples do not cross messages
  std::vector<EsfReading> readings;
  const auto keep = [&readings](const EsfReading& reading) { readings.push_back(reading); };
  for (std::size_t at = kRawHeader; at < payload.size(); at += kRawValue) {
    const std::uint8_t* p = payload.data() + at;
    const std::int64_t clock_ns = ticks_.extend(read_u4(p + 4)) * kTwoTicks_ns / 2;
    add(&raw_, esf_value(read_u4(p), 0xFF), clock_ns, keep);
  }
  for (EsfReading& reading : readings) {
    reading.sent_ns = readings.back().clock_ns;
    take(reading);
  }
}

EsfCounters EsfDecoder::counters() const {
  EsfCounters counters = counters_;
  counters.incomplete = meas_.incomplete() + raw_.incomplete();
  return counters;
}

}  // namespace leonav
