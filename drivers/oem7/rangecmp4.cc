#include "drivers/oem7/rangecmp4.h"

#include <array>
#include <bit>

#include "drivers/binary/little_endian.h"
#include "drivers/oem7/oem7_signal.h"
#include "drivers/oem7/range_count.h"

namespace leonav {
namespace {

constexpr double kRangeUnit_m = 0.0005, kCarrierUnit_m = 0.0001, kRateUnit_m_s = 0.0001;
constexpr double kStrengthUnit = 0.05;  // dB-Hz
constexpr double kLockCeiling_s = 262.144;
constexpr std::uint64_t kNoRange = (std::uint64_t{1} << 37) - 1;

// Returns a field in its unit; the most negative number means that the value is not valid.
double scaled(LowBitReader* bits, int count, double unit) {
  const std::int64_t value = bits->take_signed(count);
  const bool is_valid = value != -(std::int64_t{1} << (count - 1));
  return is_valid ? static_cast<double>(value) * unit : kNotMeasured;
}

// Returns the least time of an indicator: 16 ms, 32 ms, ... 262,144 ms.
double least_lock_s(std::uint64_t indicator) {
  return indicator == 0 ? 0.0 : static_cast<double>(std::int64_t{8} << indicator) / 1000.0;
}

}  // namespace

RangeStatus RangecmpFour::read(std::span<const std::uint8_t> payload, GpsTime time,
                               std::vector<RangeMeasurement>* measurements) {
  measurements->clear();
  if (payload.size() < kCountSize || payload.size() - kCountSize < read_u4(payload.data())) {
    return RangeStatus::kBadLength;
  }
  LowBitReader bits(payload.subspan(kCountSize, read_u4(payload.data())));
  const auto systems = static_cast<std::uint32_t>(bits.take(16));
  for (std::uint32_t system = 0; system < 16 && !bits.overrun(); ++system) {
    if ((systems >> system) & 1u) read_system(system, time, &bits, measurements);
  }
  return bits.overrun() ? RangeStatus::kBadLength : RangeStatus::kOk;
}

// The masks say which satellites and signals a system has, then, satellite by satellite, which of
// these signals are there.
void RangecmpFour::read_system(std::uint32_t system, GpsTime time, LowBitReader* bits,
                               std::vector<RangeMeasurement>* measurements) {
  const std::uint64_t satellites = bits->take(64);
  const auto signals = static_cast<std::uint32_t>(bits->take(16));
  std::array<std::uint64_t, kSatellites> included{};
  for (std::size_t i = 0; i < kSatellites; ++i) {
    if ((satellites >> i) & 1u) included[i] = bits->take(std::popcount(signals));
  }
  for (std::uint32_t i = 0; i < kSatellites && !bits->overrun(); ++i) {
    if (((satellites >> i) & 1u) == 0) continue;
    Satellite satellite;
    satellite.system = system;
    satellite.number = i + 1;
    satellite.is_differential = bits->take(1) != 0;
    satellite.block = static_cast<std::uint32_t>(bits->take(3));
    if (system == kCompressedGlonass && !satellite.is_differential) bits->skip(5);
    for (std::uint32_t signal = 0; signal < kSignals && !bits->overrun(); ++signal) {
      if (((signals >> signal) & 1u) == 0) continue;
      const bool is_included = (included[i] & 1u) != 0;
      included[i] >>= 1;
      if (!is_included) continue;
      const RangeMeasurement measurement = read_signal(signal, time, &satellite, bits);
      satellite.is_first_signal = false;
      if (!bits->overrun()) measurements->push_back(measurement);
    }
  }
}

RangeMeasurement RangecmpFour::read_signal(std::uint32_t signal, GpsTime time, Satellite* satellite,
                                           LowBitReader* bits) {
  RangeMeasurement m;
  m.system = system_from_compressed(satellite->system);
  m.number = satellite->number;
  if (m.system) m.code = signal_from_rangecmp4(*m.system, signal);
  m.parity_is_known = bits->take(1) != 0;
  m.half_cycle_is_added = bits->take(1) != 0;
  m.cn0_dbhz = static_cast<double>(bits->take(11)) * kStrengthUnit;
  m.lock_time_s = least_lock_s(bits->take(4));
  m.lock_ceiling_s = kLockCeiling_s;
  m.lock_is_least = true;
  bits->skip(4 + 4);  // standard deviations
  Signal values;
  if (satellite->is_differential) {
    values = read_difference(*satellite, signal, time, bits);
  } else {
    values = read_reference(*satellite, bits);
    if (satellite->is_first_signal) satellite->primary = values;
    if (m.system && !bits->overrun()) {
      references_[{*m.system, m.number, signal}] = {time, satellite->block, values};
    }
  }
  if (!m.code) return m;
  const double wavelength = wavelength_m(*m.system, m.code->band);
  m.pseudorange_m = values.range_m;
  m.carrier_cycles = values.carrier_m / wavelength;
  m.doppler_hz = -(values.rate_m_s / wavelength);
  return m;
}

// The first signal of a satellite is given by itself, the others relative to it.
RangecmpFour::Signal RangecmpFour::read_reference(const Satellite& satellite, LowBitReader* bits) {
  Signal values;
  if (satellite.is_first_signal) {
    const std::uint64_t range = bits->take(37);
    if (range != kNoRange) values.range_m = static_cast<double>(range) * kRangeUnit_m;
    values.carrier_m = scaled(bits, 23, kCarrierUnit_m) + values.range_m;
    values.rate_m_s = scaled(bits, 26, kRateUnit_m_s);
  } else {
    values.range_m = scaled(bits, 20, kRangeUnit_m) + satellite.primary.range_m;
    values.carrier_m = scaled(bits, 23, kCarrierUnit_m) + values.range_m;
    values.rate_m_s = scaled(bits, 14, kRateUnit_m_s) + satellite.primary.rate_m_s;
  }
  return values;
}

// The reference is that of the same signal at the last whole second, moved on by its rate.
RangecmpFour::Signal RangecmpFour::read_difference(const Satellite& satellite, std::uint32_t signal,
                                                   GpsTime time, LowBitReader* bits) {
  Signal values;
  values.range_m = scaled(bits, 19, kRangeUnit_m);
  values.carrier_m = scaled(bits, 16, kCarrierUnit_m);
  values.rate_m_s = scaled(bits, satellite.is_first_signal ? 18 : 14, kRateUnit_m_s);
  const std::optional<System> system = system_from_compressed(satellite.system);
  if (!system) return values;
  const auto found = references_.find({*system, satellite.number, signal});
  const Reference reference = found == references_.end() ? Reference{} : found->second;
  const std::int64_t since_second_ns = time.nanoseconds() % kNanosecondsPerSecond;
  if (!reference.time.is_set() || reference.block != satellite.block ||
      nanoseconds_between(time, reference.time) != since_second_ns) {
    ++without_reference_;
    return {};
  }
  const double moved_m = reference.signal.rate_m_s * static_cast<double>(since_second_ns) * 1e-9;
  values.range_m = values.range_m + reference.signal.range_m + moved_m;
  values.carrier_m = values.carrier_m + reference.signal.carrier_m + moved_m;
  values.rate_m_s = values.rate_m_s + reference.signal.rate_m_s;
  return values;
}

}  // namespace leonav
