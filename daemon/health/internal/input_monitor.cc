#include "daemon/health/internal/input_monitor.h"

#include <algorithm>

#include "daemon/health/internal/counter_sums.h"
#include "daemon/health/internal/findings.h"

namespace leonav {
namespace {

constexpr double kImuSilence_s = 0.9;       // look() comes once a second
constexpr double kOdometerSilence_s = 2.5;  // an increment lasts a second at most
constexpr double kShare = 0.1;              // of an input, that is rejected
constexpr std::int64_t kFewMessages = 5;    // fewer say nothing about a share

}  // namespace

InputMonitor::InputMonitor(const EngineCounters* counters, const NavigatorConfig& config)
    : counters_(counters),
      expects_imu_(config.motion == MotionModel::kInertial),
      uses_odometer_(expects_imu_ && config.vehicle.motion.constraints.odometer),
      imu_(kImuSilence_s),
      gnss_(kIntervalsTolerated * config.realtime.epoch_interval_s),
      odometer_(kOdometerSilence_s) {
  detail_.reserve(kDetailBytes);
}

std::span<const Finding> InputMonitor::look(double now_s) {
  found_.clear();
  faults_.look(*counters_);
  look_at_shares();
  if (expects_imu_)
    look_at_stream(counters_->accepted_imu, now_s, Channel::kImu, HealthReason::kNoImu, &imu_);
  if (!imu_.used.is_late()) epochs_without_imu_at_last_use_ = counters_->epochs_without_imu.get();
  look_at_stream(counters_->accepted_epochs, now_s, Channel::kGnssEpoch, HealthReason::kNoGnss,
                 &gnss_);
  if (uses_odometer_ && counters_->accepted_odometer.get() > 0)
    look_at_stream(counters_->accepted_odometer, now_s, Channel::kOdometer,
                   HealthReason::kNoOdometer, &odometer_);
  if (lost_.look(sum(counters_->lost))) found_.add(HealthReason::kInputLost);
  if (imu_gaps_.look(counters_->imu_gaps.get())) found_.add(HealthReason::kImuGaps);
  return found_.get();
}

void InputMonitor::look_at_shares() {
  detail_.clear();
  for (const Channel channel : kInputChannels) {
    const std::size_t i = index_of(channel);
    Rates& rates = rates_[i];
    rates.received.look(counters_->received[i].get());
    rates.refused.look(counters_->refused[i].get());
    std::int64_t unused = rates.refused.get();
    // The Sequencer counts what it takes of the streams.
    if (channel == Channel::kImu) rates.accepted.look(counters_->accepted_imu.get());
    if (channel == Channel::kGnssEpoch) rates.accepted.look(counters_->accepted_epochs.get());
    if (channel == Channel::kImu || channel == Channel::kGnssEpoch)
      unused = std::max(unused, rates.received.get() - rates.accepted.get());
    const std::int64_t received = rates.received.get();
    if (received < kFewMessages ||
        static_cast<double>(unused) < kShare * static_cast<double>(received))
      continue;
    append_to_list(name_of(channel), &detail_);
    append_fault(channel);
  }
  if (!detail_.empty()) found_.add(HealthReason::kInputRejected, detail_);
}

void InputMonitor::look_at_stream(const Gauge& accepted, double now_s, Channel channel,
                                  HealthReason reason, Stream* stream) {
  stream->used.look(accepted.get(), now_s);
  stream->any.look(counters_->received[index_of(channel)].get(), now_s);
  if (!stream->used.is_late()) return;
  if (stream->any.is_late()) return found_.add(reason, "nothing comes");
  const bool rejected = faults_.most_frequent(channel) != InputFault::kNone;
  found_.add(reason, rejected ? with_fault("messages come, but are rejected", channel)
                              : "messages come, but too late");
}

std::string_view InputMonitor::why_no_epoch(bool none_since_start) {
  const bool had_imu = counters_->accepted_imu.get() > 0;
  // Epochs wait for a silent IMU for some seconds, and then no longer.
  const bool epochs_wait_for_imu =
      expects_imu_ && counters_->epochs_without_imu.get() == epochs_without_imu_at_last_use_;
  if (counters_->received[index_of(Channel::kGnssEpoch)].get() == 0)
    return "no GNSS has come: look at its sender and lcm.url";
  if (counters_->accepted_epochs.get() == 0) return with_clocks("all GNSS epochs are rejected");
  if (epochs_wait_for_imu && counters_->received[index_of(Channel::kImu)].get() == 0)
    return "no IMU sample has come: look at its sender and lcm.url";
  if (epochs_wait_for_imu && !had_imu) {
    with_fault("all IMU samples are rejected", Channel::kImu);
    return detail_ += ": look at their sender";
  }
  if (epochs_wait_for_imu && lacks_imu())
    return "no IMU sample is used any more: look at its sender";
  if (!gnss_.used.is_late()) return "";
  if (!are_clocks_apart()) return "no GNSS epoch is used any more: look at its sender";
  // What was rejected before the start was compared with a time of the IMU that holds no more.
  if (none_since_start) return "";
  return with_clocks("the GNSS epochs are rejected");
}

bool InputMonitor::is_silent() const {
  return (expects_imu_ && imu_.any.is_late()) || gnss_.any.is_late();
}

// Adds " as ..." with the fault by which most inputs of the channel are rejected.
void InputMonitor::append_fault(Channel channel) {
  const InputFault fault = faults_.most_frequent(channel);
  if (fault != InputFault::kNone) detail_.append(" as ").append(to_string(fault));
}

std::string_view InputMonitor::with_fault(std::string_view text, Channel channel) {
  detail_.assign(text);
  append_fault(channel);
  return detail_;
}

// Whether the epochs are rejected because their time is not that of the IMU.
bool InputMonitor::are_clocks_apart() const {
  if (!expects_imu_ || counters_->accepted_imu.get() == 0) return false;
  const InputFault fault = faults_.most_frequent(Channel::kGnssEpoch);
  return fault == InputFault::kTimeBackwards || fault == InputFault::kTooFarAhead;
}

std::string_view InputMonitor::with_clocks(std::string_view text) {
  with_fault(text, Channel::kGnssEpoch);
  return detail_ += are_clocks_apart()
                        ? ", their time is not that of the IMU: compare the two clocks"
                        : ": look at their sender";
}

}  // namespace leonav
