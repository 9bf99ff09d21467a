#include "tools/import/ubx_samples.h"

namespace leonav {
ImuReading imu_reading(const EsfReading& reading, std::int64_t arrival_ns) {
  ImuReading result;
  result.arrival_ns = arrival_ns;
  result.clock_ns = reading.clock_ns;
  result.gyro = to_vector(reading.angular_rate_rad_s);
  result.accel = to_vector(reading.specific_force_m_s2);
  return result;
}

void UbxSamples::on_epoch(GpsTime time) {
  gps_.on_epoch(time, time.nanoseconds());
  last_epoch_ = time;
  sent_before_ns_ = last_sent_ns_;
  clock_at_epoch_ns_.reset();
}

double UbxSamples::uncertainty_s() const {
  return epochs_ > 0 ? apart_s_ / static_cast<double>(epochs_) / 2.0 : 0.0;
}

std::optional<ImuSample> UbxSamples::take(const EsfReading& reading) {
  if (!clock_at_epoch_ns_ && sent_before_ns_) {
    const std::int64_t apart_ns = reading.sent_ns - *sent_before_ns_;
    clock_at_epoch_ns_ = *sent_before_ns_ + apart_ns / 2;
    apart_s_ += static_cast<double>(apart_ns) * 1e-9;
    ++epochs_;
  }
  last_sent_ns_ = reading.sent_ns;
  if (!clock_at_epoch_ns_) {
    ++before_tie_;
    return std::nullopt;
  }
  const std::int64_t arrival_ns =
      last_epoch_.nanoseconds() + reading.clock_ns - *clock_at_epoch_ns_;
  const ImuReading imu = imu_reading(reading, arrival_ns);
  const std::uint64_t contradictions = stamper_.contradictions();
  const std::optional<GpsTime> time = stamper_.stamp(imu);
  if (!time) {
    before_tie_ += stamper_.contradictions() == contradictions;
    return std::nullopt;
  }
  return sampler_.sample(*time, imu);
}

}  // namespace leonav
