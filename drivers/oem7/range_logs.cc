#include "drivers/oem7/range_logs.h"

#include <cmath>

#include "drivers/binary/little_endian.h"
#include "drivers/oem7/oem7_signal.h"
#include "drivers/oem7/range_count.h"

namespace leonav {
namespace {

constexpr std::size_t kRangeSize = 44, kRangecmpSize = 24;

// Fills in what the tracking status says, and returns whether the values are of use.
bool read_status(std::uint32_t word, RangeMeasurement* m) {
  const TrackingStatus status(word);
  m->system = status.system();
  if (!m->system) return false;
  m->code = status.signal();
  m->parity_is_known = status.parity_is_known();
  m->half_cycle_is_added = status.half_cycle_is_added();
  return m->code.has_value();
}

// Values count while their loop is locked; the Doppler is of either.
void keep_locked(std::uint32_t word, RangeMeasurement* m) {
  const TrackingStatus status(word);
  if (!status.code_is_locked()) m->pseudorange_m = kNotMeasured;
  if (!status.phase_is_locked()) m->carrier_cycles = kNotMeasured;
  if (!status.code_is_locked() && !status.phase_is_locked()) m->doppler_hz = kNotMeasured;
}

RangeMeasurement read_range_record(const std::uint8_t* p) {
  RangeMeasurement m;
  m.number = read_u2(p);
  const std::uint32_t status = read_u4(p + 40);
  if (!read_status(status, &m)) return m;
  m.pseudorange_m = read_r8(p + 4);
  m.carrier_cycles = -read_r8(p + 16);
  m.doppler_hz = read_r4(p + 28);
  m.cn0_dbhz = read_r4(p + 32);
  m.lock_time_s = read_r4(p + 36);
  keep_locked(status, &m);
  return m;
}

RangeMeasurement read_rangecmp_record(const std::uint8_t* p) {
  constexpr double kRollCycles = 8388608.0;
  constexpr double kLockCeiling = 0x1FFFFF / 32.0;
  constexpr std::uint32_t kDopplerSign = 1u << 27;
  RangeMeasurement m;
  m.number = p[17];
  const std::uint32_t status = read_u4(p);
  if (!read_status(status, &m)) return m;
  const std::uint64_t doppler_and_range = read_u8(p + 4);
  const auto doppler = static_cast<std::uint32_t>(doppler_and_range & 0xFFFFFFF);
  m.doppler_hz = static_cast<std::int32_t>((doppler ^ kDopplerSign) - kDopplerSign) / 256.0;
  m.pseudorange_m = static_cast<double>(doppler_and_range >> 28) / 128.0;
  const double cut = -(static_cast<std::int32_t>(read_u4(p + 12)) / 256.0);
  const double expected = m.pseudorange_m * frequency_hz(*m.system, m.code->band) / kSpeedOfLight;
  m.carrier_cycles = cut + kRollCycles * std::round((expected - cut) / kRollCycles);
  const std::uint32_t rest = read_u4(p + 18);
  m.lock_time_s = (rest & 0x1FFFFF) / 32.0;
  m.lock_ceiling_s = kLockCeiling;
  m.cn0_dbhz = 20.0 + ((rest >> 21) & 0x1F);
  keep_locked(status, &m);
  if (std::isnan(m.pseudorange_m)) m.carrier_cycles = kNotMeasured;
  return m;
}

template <typename ReadRecord>
RangeStatus read_records(std::span<const std::uint8_t> payload, std::size_t size,
                         std::vector<RangeMeasurement>* measurements, ReadRecord read_record) {
  measurements->clear();
  if (payload.size() < kCountSize || (payload.size() - kCountSize) / size < read_u4(payload.data()))
    return RangeStatus::kBadLength;
  const std::size_t count = read_u4(payload.data());
  for (std::size_t i = 0; i < count; ++i) {
    measurements->push_back(read_record(payload.data() + kCountSize + i * size));
  }
  return RangeStatus::kOk;
}

}  // namespace

RangeStatus read_range(std::span<const std::uint8_t> payload,
                       std::vector<RangeMeasurement>* measurements) {
  return read_records(payload, kRangeSize, measurements, read_range_record);
}

RangeStatus read_rangecmp(std::span<const std::uint8_t> payload,
                          std::vector<RangeMeasurement>* measurements) {
  return read_records(payload, kRangecmpSize, measurements, read_rangecmp_record);
}

}  // namespace leonav
