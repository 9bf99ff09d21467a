#include "daemon/engine/internal/input_counters.h"

#include <algorithm>
#include <array>

namespace leonav {
namespace {

std::int64_t odometer_age_ms(const Sequencer& sequencer) {
  const GpsTime last = sequencer.odometer_time(), now = sequencer.imu_time();
  if (!last.is_set() || !now.is_set()) return -1;
  return std::max<std::int64_t>(0, nanoseconds_between(now, last) / 1'000'000);
}

}  // namespace

void copy_input_counters(const InputDispatch& dispatch, const Sequencer& sequencer,
                         EngineCounters* counters) {
  const InputDispatch::Counters& inputs = dispatch.counters();
  for (std::size_t i = 0; i < kInputChannels.size(); ++i) {
    counters->received[i].set(static_cast<std::int64_t>(inputs.received[i]));
    counters->refused[i].set(static_cast<std::int64_t>(inputs.refused[i]));
    for (std::size_t fault = 0; fault < kInputFaultCount; ++fault)
      counters->refused_by[i][fault].set(static_cast<std::int64_t>(inputs.refused_by[i][fault]));
    counters->lost[i].set(static_cast<std::int64_t>(inputs.lost[i]));
  }
  const Sequencer::Counters& from = sequencer.counters();
  for (std::size_t i = 0; i < from.rejected.size(); ++i) {
    counters->rejected[i].set(static_cast<std::int64_t>(from.rejected[i] + from.refused[i]));
  }
  const std::array streams = {&from.rejected_imu, &from.rejected_epochs, &from.rejected_odometer};
  static_assert(streams.size() == kStreams.size());
  for (std::size_t stream = 0; stream < kStreams.size(); ++stream) {
    for (std::size_t i = 0; i < streams[stream]->size(); ++i)
      counters->rejected_of_stream[stream][i].set(static_cast<std::int64_t>((*streams[stream])[i]));
  }
  counters->accepted_imu.set(static_cast<std::int64_t>(from.imu));
  counters->accepted_epochs.set(static_cast<std::int64_t>(from.epochs));
  counters->accepted_odometer.set(static_cast<std::int64_t>(from.odometer - from.late_odometer));
  counters->late_odometer.set(static_cast<std::int64_t>(from.late_odometer));
  counters->odometer_age_ms.set(odometer_age_ms(sequencer));
  counters->empty_epochs.set(static_cast<std::int64_t>(from.empty_epochs));
  counters->late_epochs.set(static_cast<std::int64_t>(from.late_epochs));
  counters->epochs_without_imu.set(static_cast<std::int64_t>(from.epochs_without_imu));
  counters->imu_gaps.set(static_cast<std::int64_t>(from.imu_gaps));
  counters->imu_smoothed.set(static_cast<std::int64_t>(from.imu_smoothed));
}

}  // namespace leonav
