#include "drivers/sbf/meas_epoch.h"

#include <cmath>

#include "drivers/binary/little_endian.h"
#include "drivers/sbf/sbf_signal.h"

namespace leonav {
namespace {

// Number of masters, lengths of both sub-blocks, flags, clock jumps, reserved.
constexpr std::size_t kEpochHeadSize = 6;
constexpr std::size_t kMasterSize = 20, kSlaveSize = 12;
constexpr std::uint8_t kE6IsB = 1u << 6, kScrambledFlag = 1u << 7;

constexpr double kRangeUnit_m = 0.001, kCarrierUnit = 0.001, kDopplerUnit_hz = 0.0001;
constexpr double kStrengthUnit = 0.25, kStrengthOffset = 10.0;  // dB-Hz
constexpr double kTwo32 = 4294967296.0, kTwo16 = 65536.0;

// Values that mean "not measured".
constexpr std::uint8_t kNoStrength = 255;
constexpr std::int32_t kNoDoppler = INT32_MIN;
constexpr int kNoCarrierHigh = -128, kNoCodeHigh = -4, kNoDopplerHigh = -16;

// Longest lock times that the fields hold; the next number means that there is none.
constexpr std::uint32_t kMasterCeiling_s = 65534, kSlaveCeiling_s = 254;

int signed_byte(std::uint8_t byte) { return static_cast<std::int8_t>(byte); }

// Returns the `bits` lowest bits of `value` in two's complement.
int signed_bits(unsigned value, int bits) {
  const unsigned sign = 1u << (bits - 1);
  return static_cast<int>((value & (2 * sign - 1)) ^ sign) - static_cast<int>(sign);
}

// What both kinds of sub-blocks hold.
struct Common {
  std::uint8_t type = 0, strength = 0, info = 0;
  std::uint32_t lock_s = 0, lock_ceiling_s = 0;
  int carrier_high = 0;
  std::uint16_t carrier_low = 0;

  std::uint32_t signal_number() const { return sbf_signal_number(type & 0x1Fu, info >> 3); }
  bool is_main_antenna() const { return (type >> 5) == 0; }
};

// Fills in what follows from a sub-block once the code is known. The master's Doppler is scaled by
// whoever knows both frequencies.
RangeMeasurement describe(std::uint8_t satellite_number, const Common& common, bool e6_is_b,
                          double pseudorange_m) {
  RangeMeasurement m;
  const std::optional<SatelliteId> satellite = satellite_from_sbf(satellite_number);
  if (!satellite) return m;
  m.system = satellite->system;
  m.number = satellite->number;
  const std::optional<SbfSignal> signal = signal_from_sbf(common.signal_number(), e6_is_b);
  if (!signal || signal->system != satellite->system) return m;
  m.code = signal->code;
  m.pseudorange_m = pseudorange_m;
  if (common.carrier_high != kNoCarrierHigh || common.carrier_low != 0) {
    const double offset = (common.carrier_high * kTwo16 + common.carrier_low) * kCarrierUnit;
    m.carrier_cycles = pseudorange_m / wavelength_m(*m.system, m.code->band) + offset;
  }
  if (common.strength != kNoStrength) {
    const bool is_p_code = *m.system == System::kGps && m.code->attribute == 'W';
    m.cn0_dbhz = common.strength * kStrengthUnit + (is_p_code ? 0.0 : kStrengthOffset);
  }
  m.lock_time_s = common.lock_s > common.lock_ceiling_s ? kNotMeasured : common.lock_s;
  m.lock_ceiling_s = common.lock_ceiling_s;
  m.lock_unit_s = 1.0;
  m.parity_is_known = (common.info & 4u) == 0;
  return m;
}

// A satellite's master signal, with what its slaves are relative to.
struct Master {
  Master(const std::uint8_t* p, bool e6_is_b) : satellite(p[2]), slaves(p[19]) {
    Common common;
    common.type = p[1];
    common.carrier_low = read_u2(p + 12);
    common.carrier_high = signed_byte(p[14]);
    common.strength = p[15];
    common.lock_s = read_u2(p + 16);
    common.lock_ceiling_s = kMasterCeiling_s;
    common.info = p[18];
    is_main_antenna = common.is_main_antenna();
    const unsigned high = p[3] & 0x0Fu;
    const std::uint32_t low = read_u4(p + 4);
    if (high != 0 || low != 0) pseudorange_m = (high * kTwo32 + low) * kRangeUnit_m;
    const auto doppler = static_cast<std::int32_t>(read_u4(p + 8));
    measurement = describe(satellite, common, e6_is_b, pseudorange_m);
    if (!measurement.code || doppler == kNoDoppler) return;
    doppler_hz = doppler * kDopplerUnit_hz;
    frequency = frequency_hz(*measurement.system, measurement.code->band);
    measurement.doppler_hz = doppler_hz;
  }

  std::uint8_t satellite;
  std::size_t slaves;
  bool is_main_antenna = false;
  double pseudorange_m = kNotMeasured;
  double doppler_hz = kNotMeasured, frequency = kNotMeasured;
  RangeMeasurement measurement;
};

struct Slave {
  Slave(const std::uint8_t* p, const Master& master, bool e6_is_b) {
    Common common;
    common.type = p[0];
    common.lock_s = p[1];
    common.lock_ceiling_s = kSlaveCeiling_s;
    common.strength = p[2];
    common.carrier_high = signed_byte(p[4]);
    common.info = p[5];
    common.carrier_low = read_u2(p + 8);
    is_main_antenna = common.is_main_antenna();
    const int code_high = signed_bits(p[3], 3), doppler_high = signed_bits(p[3] >> 3, 5);
    const std::uint16_t code_low = read_u2(p + 6), doppler_low = read_u2(p + 10);
    double pseudorange_m = kNotMeasured;
    if (code_high != kNoCodeHigh || code_low != 0) {
      pseudorange_m = master.pseudorange_m + (code_high * kTwo16 + code_low) * kRangeUnit_m;
    }
    measurement = describe(master.satellite, common, e6_is_b, pseudorange_m);
    if (!measurement.code || (doppler_high == kNoDopplerHigh && doppler_low == 0)) return;
    const double ratio =
        frequency_hz(*measurement.system, measurement.code->band) / master.frequency;
    measurement.doppler_hz =
        master.doppler_hz * ratio + (doppler_high * kTwo16 + doppler_low) * kDopplerUnit_hz;
  }

  bool is_main_antenna = false;
  RangeMeasurement measurement;
};

}  // namespace

MeasEpochStatus read_meas_epoch(std::span<const std::uint8_t> payload,
                                std::vector<RangeMeasurement>* measurements,
                                std::uint64_t* other_antennas) {
  measurements->clear();
  if (payload.size() < kEpochHeadSize) return MeasEpochStatus::kBadLength;
  const std::size_t masters = payload[0], master_size = payload[1], slave_size = payload[2];
  const std::uint8_t flags = payload[3];
  if ((flags & kScrambledFlag) != 0) return MeasEpochStatus::kScrambled;
  const bool e6_is_b = (flags & kE6IsB) != 0;
  const auto put = [&](const auto& sub_block) {
    if (sub_block.is_main_antenna) {
      measurements->push_back(sub_block.measurement);
    } else {
      ++*other_antennas;
    }
  };
  auto rest = payload.subspan(kEpochHeadSize);
  for (std::size_t i = 0; i < masters; ++i) {
    if (master_size < kMasterSize || rest.size() < master_size) return MeasEpochStatus::kBadLength;
    const Master master(rest.data(), e6_is_b);
    rest = rest.subspan(master_size);
    if (master.slaves > 0 &&
        (slave_size < kSlaveSize || rest.size() < master.slaves * slave_size)) {
      return MeasEpochStatus::kBadLength;
    }
    put(master);
    for (std::size_t k = 0; k < master.slaves; ++k) {
      put(Slave(rest.data(), master, e6_is_b));
      rest = rest.subspan(slave_size);
    }
  }
  return MeasEpochStatus::kOk;
}

}  // namespace leonav
