#include "drivers/binary/range_epoch.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

// Bounds on what a receiver on or near the Earth can measure, with a clock error of tens of
// milliseconds. Values outside are damage or malice.
constexpr double kMinPseudorange = 1e6;  // m
constexpr double kMaxPseudorange = 1e8;  // m
constexpr double kMaxCarrier = 1e10;     // cycles
constexpr double kMaxDoppler = 1e5;      // Hz
constexpr double kMaxCn0 = 80.0;         // dB-Hz
constexpr double kMaxLockTime = 1e9;     // s

}  // namespace

bool RangeEpochs::assemble(GpsTime time, std::span<const RangeMeasurement> measurements,
                           RawEpoch* epoch) {
  if (time == last_time_) {
    ++counters_.repeated;
    return false;
  }
  last_time_ = time;
  epoch->time = time;
  signals_.clear();
  for (const RangeMeasurement& measurement : measurements) {
    SignalObservation observation;
    if (take(time, measurement, &observation)) signals_.push_back(observation);
  }
  sort_and_drop_duplicates();
  capacity_.fit(&signals_, epoch);
  ++counters_.epochs;
  counters_.measurements += epoch->observations.size();
  return true;
}

double RangeEpochs::checked(double value, double low, double high) {
  if (value >= low && value <= high) return value;
  if (!std::isnan(value)) ++counters_.bad_value;
  return kNotMeasured;
}

bool RangeEpochs::take(GpsTime time, const RangeMeasurement& m, SignalObservation* observation) {
  if (!m.system) {
    ++counters_.other_system;
    return false;
  }
  if (!m.code) {
    ++counters_.unknown_signal;
    return false;
  }
  SignalObservation& o = *observation;
  o.satellite = {*m.system, static_cast<std::uint16_t>(m.number)};
  if (m.number > kHighestNumber[index_of(*m.system)] || !is_valid(o.satellite)) {
    ++counters_.bad_satellite;
    return false;
  }
  o.code = *m.code;
  o.pseudorange_m = checked(m.pseudorange_m, kMinPseudorange, kMaxPseudorange);
  o.carrier_cycles = checked(m.carrier_cycles, -kMaxCarrier, kMaxCarrier);
  o.doppler_hz = checked(m.doppler_hz, -kMaxDoppler, kMaxDoppler);
  if (m.cn0_dbhz != 0.0) o.cn0_dbhz = checked(m.cn0_dbhz, 1.0, kMaxCn0);
  o.lock_time_s = checked(m.lock_time_s, 0.0, kMaxLockTime);
  if (std::isnan(o.pseudorange_m) && std::isnan(o.carrier_cycles) && std::isnan(o.doppler_hz)) {
    ++counters_.empty;
    return false;
  }
  if (!std::isnan(o.carrier_cycles)) {
    Lock& last = locks_[{o.satellite, o.code}];
    o.half_cycle_ambiguous = !m.parity_is_known;
    o.loss_of_lock = lock_was_lost(time, m, last);
    last = {time, m.lock_time_s, m.half_cycle_is_added};
  }
  return true;
}

// `last` is the last epoch with this carrier, so that a lock lost and found again without a carrier
// in between is recognized too.
bool RangeEpochs::lock_was_lost(GpsTime time, const RangeMeasurement& now, const Lock& last) const {
  if (!(now.lock_time_s > 0.0)) return true;
  if (!last.time.is_set()) return false;  // nothing to be continuous with
  if (now.half_cycle_is_added != last.half_cycle_is_added) return true;
  const double elapsed_s = seconds_between(time, last.time);
  if (elapsed_s < 0.0 || now.lock_time_s < last.lock_time_s) return true;
  // Of a time that has come to the end of its count only so much is known.
  if (now.lock_is_least || now.lock_time_s >= now.lock_ceiling_s) {
    return now.lock_time_s < elapsed_s;
  }
  // Of a count that is cut off, a lock that began after the last epoch may look as old as one that
  // began with it.
  if (now.lock_unit_s > 0.0 && now.lock_time_s < elapsed_s) return true;
  // The count is in single precision or in steps of 1/32 s, and taken a little before or after the
  // epoch.
  const double step_s = 0.05 + now.lock_time_s * 0x1p-22 + now.lock_unit_s;
  return now.lock_time_s - last.lock_time_s + step_s < elapsed_s;
}

void RangeEpochs::sort_and_drop_duplicates() {
  auto& all = signals_;
  std::stable_sort(all.begin(), all.end(), comes_before);
  const auto end = std::unique(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return a.satellite == b.satellite && a.code == b.code;
  });
  counters_.duplicates += static_cast<std::uint64_t>(all.end() - end);
  all.erase(end, all.end());
}

}  // namespace leonav
