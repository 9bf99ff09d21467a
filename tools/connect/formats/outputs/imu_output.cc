#include "tools/connect/formats/outputs/imu_output.h"

namespace leonav {

void ImuOutput::take(const ImuReading& reading) {
  if (reading.gps_time) {
    data_time_ = {true, reading.gps_time->nanoseconds()};
  } else if (reading.clock_ns) {
    data_time_ = {false, *reading.clock_ns};
  }
  const std::optional<GpsTime> time = stamper_.stamp(reading);
  if (!time) return;
  const std::optional<ImuSample> sample = sampler_.sample(*time, reading);
  if (!sample) return;
  output_->send(*sample);
  output_->note_time(sample->time);
  ++messages_;
}

std::uint64_t ImuOutput::refused() const {
  const ImuSamplerCounters& c = sampler_.counters();
  return stamper_.contradictions() + c.out_of_order + c.impossible;
}

}  // namespace leonav
