#include "drivers/oem7/rangecmp2.h"

#include "drivers/binary/little_endian.h"
#include "drivers/oem7/low_bit_reader.h"
#include "drivers/oem7/oem7_signal.h"
#include "drivers/oem7/range_count.h"

namespace leonav {
namespace {

constexpr std::size_t kSatelliteSize = 10, kSignalSize = 12;

// What all signals of a satellite are given relative to.
struct SatelliteBlock {
  explicit SatelliteBlock(std::span<const std::uint8_t> bytes) {
    LowBitReader r(bytes);
    r.skip(8);  // channel
    number = static_cast<std::uint32_t>(r.take(8));
    r.skip(4);  // GLONASS frequency
    system = static_cast<std::uint32_t>(r.take(5));
    r.skip(1);
    pseudorange_m = static_cast<double>(r.take_signed(29));
    doppler_hz = static_cast<double>(r.take_signed(21));
    signals = static_cast<std::size_t>(r.take(4));
  }
  std::uint32_t number = 0, system = 0;
  double pseudorange_m = 0.0, doppler_hz = 0.0;
  std::size_t signals = 0;
};

// Returns the carrier to whose frequency the log scales a system's Dopplers.
double doppler_frequency_hz(System system) {
  return frequency_hz(system, system == System::kBeidou ? '2' : '1');
}

RangeMeasurement read_signal(const SatelliteBlock& satellite, std::span<const std::uint8_t> bytes) {
  constexpr double kLockCeiling = 131.071;
  RangeMeasurement m;
  m.system = system_from_compressed(satellite.system);
  m.number = satellite.number;
  if (!m.system) return m;
  LowBitReader r(bytes);
  m.code = signal_from_rangecmp2(*m.system, static_cast<std::uint32_t>(r.take(5)));
  if (!m.code) return m;
  const bool phase_is_locked = r.take(1) != 0;
  m.parity_is_known = r.take(1) != 0;
  const bool code_is_locked = r.take(1) != 0;
  m.lock_time_s = static_cast<double>(r.take(17)) / 1000.0;
  m.lock_ceiling_s = kLockCeiling;
  r.skip(4 + 1);  // correlator, primary signal
  m.half_cycle_is_added = r.take(1) != 0;
  r.skip(1);
  m.cn0_dbhz = 20.0 + static_cast<double>(r.take(5));
  r.skip(4 + 4);  // standard deviations
  const double code_part_m = static_cast<double>(r.take(14)) / 128.0;
  const double carrier_part_m = static_cast<double>(r.take(20)) / 2048.0;
  const double doppler_part_hz = static_cast<double>(r.take_signed(17)) / 256.0;
  const double carrier_hz = frequency_hz(*m.system, m.code->band);
  if (code_is_locked) m.pseudorange_m = satellite.pseudorange_m + code_part_m;
  if (phase_is_locked) {
    m.carrier_cycles =
        (satellite.pseudorange_m + carrier_part_m) / wavelength_m(*m.system, m.code->band);
  }
  if (code_is_locked || phase_is_locked) {
    m.doppler_hz =
        (satellite.doppler_hz + doppler_part_hz) * carrier_hz / doppler_frequency_hz(*m.system);
  }
  return m;
}

}  // namespace

RangeStatus read_rangecmp2(std::span<const std::uint8_t> payload,
                           std::vector<RangeMeasurement>* measurements) {
  measurements->clear();
  if (payload.size() < kCountSize || payload.size() - kCountSize < read_u4(payload.data())) {
    return RangeStatus::kBadLength;
  }
  auto rest = payload.subspan(kCountSize, read_u4(payload.data()));
  while (!rest.empty()) {
    if (rest.size() < kSatelliteSize) return RangeStatus::kBadLength;
    const SatelliteBlock satellite(rest.first(kSatelliteSize));
    rest = rest.subspan(kSatelliteSize);
    if (rest.size() < satellite.signals * kSignalSize) return RangeStatus::kBadLength;
    for (std::size_t i = 0; i < satellite.signals; ++i) {
      measurements->push_back(read_signal(satellite, rest.first(kSignalSize)));
      rest = rest.subspan(kSignalSize);
    }
  }
  return RangeStatus::kOk;
}

}  // namespace leonav
