#include "drivers/ubx/rxm_rawx.h"

#include <algorithm>
#include <cmath>

#include "core/base/calendar.h"
#include "drivers/binary/little_endian.h"
#include "drivers/ubx/ubx_signal.h"

namespace leonav {
namespace {

constexpr std::size_t kRawxHeaderSize = 16;
constexpr std::size_t kBlockSize = 32;
constexpr std::uint8_t kRawxVersion = 1;

// Bounds on what a receiver on or near the Earth can measure, with a clock error of tens of
// milliseconds. Values outside are damage or malice.
constexpr double kMinPseudorange = 1e6;  // m
constexpr double kMaxPseudorange = 1e8;  // m
constexpr double kMaxCarrier = 1e10;     // cycles
constexpr double kMaxDoppler = 1e5;      // Hz
constexpr int kMaxCn0 = 80;              // dBHz
constexpr int kLockTimeCeiling = 64500;  // ms: the counter stays there
constexpr int kNoCarrierStd = 15;        // cpStdev: no estimate

// Bits of trkStat.
constexpr std::uint8_t kPseudorangeValid = 1;
constexpr std::uint8_t kCarrierValid = 2;
constexpr std::uint8_t kHalfCycleKnown = 4;
constexpr std::uint8_t kHalfCycleSubtracted = 8;

// One measurement block of the message, with the message's own units.
struct Block {
  explicit Block(const std::uint8_t* p)
      : pseudorange_m(read_r8(p)),
        carrier_cycles(read_r8(p + 8)),
        doppler_hz(read_r4(p + 16)),
        gnss_id(p[20]),
        satellite_number(p[21]),
        signal_id(p[22]),
        lock_time_ms(read_u2(p + 24)),
        cn0_dbhz(p[26]),
        carrier_std_index(p[28] & 0x0F),
        tracking(p[30]) {}
  double pseudorange_m, carrier_cycles, doppler_hz;
  std::uint8_t gnss_id, satellite_number, signal_id;
  std::uint16_t lock_time_ms;
  int cn0_dbhz, carrier_std_index;
  std::uint8_t tracking;
};

bool is_within(double value, double low, double high) {
  return std::isfinite(value) && value >= low && value <= high;
}

}  // namespace

RxmRawxDecoder::RxmRawxDecoder(const RxmRawxOptions& options) : options_(options) {}

RxmRawxStatus RxmRawxDecoder::decode(std::span<const std::uint8_t> payload, RawEpoch* epoch) {
  if (payload.size() < kRawxHeaderSize ||
      payload.size() != kRawxHeaderSize + payload[11] * kBlockSize) {
    ++counters_.bad_length;
    return RxmRawxStatus::kBadLength;
  }
  if (payload[13] != kRawxVersion) {
    ++counters_.bad_version;
    return RxmRawxStatus::kBadVersion;
  }
  const double tow_s = read_r8(payload.data());
  const int week = read_u2(payload.data() + 8);
  // The receiver sends week zero before it has the time.
  if (!is_within(tow_s, 0.0, static_cast<double>(kSecondsPerWeek)) || week < 1 ||
      week > kLastGpsWeek) {
    ++counters_.bad_time;
    return RxmRawxStatus::kBadTime;
  }
  // The time tag is the receiver's own clock and not rounded: its offset from whole milliseconds
  // belongs to the pseudoranges.
  epoch->time = GpsTime::from_week_and_tow(week, tow_s);
  epoch->observations.clear();
  for (std::size_t i = 0; i < payload[11]; ++i) {
    SignalObservation observation;
    if (decode_measurement(payload.data() + kRawxHeaderSize + i * kBlockSize, epoch->time,
                           &observation)) {
      epoch->observations.push_back(observation);
    }
  }
  static_assert(kMaxObservations >= 255, "a message may hold 255 measurements");
  sort_and_drop_duplicates(epoch);
  ++counters_.epochs;
  counters_.measurements += epoch->observations.size();
  return RxmRawxStatus::kOk;
}

void RxmRawxDecoder::sort_and_drop_duplicates(RawEpoch* epoch) {
  auto& all = epoch->observations;
  std::stable_sort(all.begin(), all.end(), comes_before);
  const auto end = std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.satellite == b.satellite && a.code == b.code;
  });
  counters_.duplicates += static_cast<std::uint64_t>(all.end() - end);
  all.erase(end, all.end());
}

bool RxmRawxDecoder::decode_measurement(const std::uint8_t* bytes, GpsTime time,
                                        SignalObservation* observation) {
  const Block block(bytes);
  const std::optional<System> system = system_from_ubx(block.gnss_id);
  if (!system) {
    ++counters_.other_system;
    return false;
  }
  observation->satellite = {*system, block.satellite_number};
  if (!is_valid(observation->satellite) || block.satellite_number >= kSatellites) {
    ++counters_.bad_satellite;
    return false;
  }
  const std::optional<SignalCode> code = signal_from_ubx(*system, block.signal_id);
  if (!code || block.signal_id >= kSignalIds) {
    ++counters_.unknown_signal;
    return false;
  }
  observation->code = *code;

  const auto checked = [this](double value, double low, double high) {
    if (is_within(value, low, high)) return value;
    ++counters_.bad_value;
    return kNotMeasured;
  };
  if (block.tracking & kPseudorangeValid) {
    observation->pseudorange_m = checked(block.pseudorange_m, kMinPseudorange, kMaxPseudorange);
  }
  // Before the first lock the carrier is 0, or -0.5 once the half cycle is subtracted.
  const bool has_carrier = (block.tracking & kCarrierValid) && block.carrier_cycles != 0.0 &&
                           block.carrier_cycles != -0.5 &&
                           block.carrier_std_index <= options_.max_carrier_std_index;
  if (has_carrier) {
    observation->carrier_cycles = checked(block.carrier_cycles, -kMaxCarrier, kMaxCarrier);
  }
  observation->doppler_hz = checked(block.doppler_hz, -kMaxDoppler, kMaxDoppler);
  if (block.cn0_dbhz > 0) observation->cn0_dbhz = checked(block.cn0_dbhz, 1, kMaxCn0);
  observation->lock_time_s = block.lock_time_ms * 1e-3;
  LockState& state = lock_[{observation->satellite, block.signal_id}];
  if (block.carrier_std_index == kNoCarrierStd) state.suspect = true;
  if (std::isfinite(observation->carrier_cycles)) {
    observation->half_cycle_ambiguous = !(block.tracking & kHalfCycleKnown);
    const bool subtracted = block.tracking & kHalfCycleSubtracted;
    const LockState now{time, block.lock_time_ms, subtracted, false};
    observation->loss_of_lock = lock_was_lost(state, now);
    state = now;
  }
  if (std::isnan(observation->pseudorange_m) && std::isnan(observation->carrier_cycles) &&
      std::isnan(observation->doppler_hz)) {
    ++counters_.empty;
    return false;
  }
  return true;
}

// `last` is the last epoch with a valid carrier, so that a lock lost and found again without a
// carrier in between is recognized too: the lock is then younger than that epoch.
bool RxmRawxDecoder::lock_was_lost(const LockState& last, const LockState& now) {
  if (now.lock_time_ms == 0) return true;
  // First epoch of the signal: nothing to be continuous with.
  if (!last.time.is_set()) return false;
  if (last.suspect || now.half_cycle_subtracted != last.half_cycle_subtracted) return true;
  if (now.lock_time_ms < last.lock_time_ms) return true;
  const double elapsed_ms = seconds_between(now.time, last.time) * 1e3;
  // The counter steps in milliseconds and is taken a little before or after the time tag.
  constexpr double kCounterStepMs = 2.0;
  if (elapsed_ms < 0.0) return true;
  if (now.lock_time_ms >= kLockTimeCeiling) return elapsed_ms > kLockTimeCeiling;
  return now.lock_time_ms + kCounterStepMs < elapsed_ms;
}

}  // namespace leonav
