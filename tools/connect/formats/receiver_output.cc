#include "tools/connect/formats/receiver_output.h"

#include "tools/common/format.h"
#include "tools/import/product_schedule.h"

namespace leonav {

void ReceiverOutput::send(const RawEpoch& epoch, std::int64_t arrival_ns) {
  clock_->on_epoch(epoch.time, arrival_ns);
  last_epoch_ = epoch.time;
  last_signals_ = epoch.observations.size();
  output_->send(epoch);
  output_->note_time(epoch.time);
  ++messages_;
  repeat_ephemerides(epoch.time);
}

void ReceiverOutput::repeat_ephemerides(GpsTime now) {
  messages_ += static_cast<std::uint64_t>(repeater_.repeat(now));
}

void ReceiverOutput::send(const Ephemeris& ephemeris) {
  Ephemeris sent = ephemeris;
  sent.transmission_time = transmission_time(ephemeris);
  output_->send(sent);
  if (corrections_ != nullptr) corrections_->add(sent);
  repeater_.remember(sent, last_epoch_.is_set() ? last_epoch_ : sent.transmission_time);
  ++messages_;
  ++ephemerides_;
}

void ReceiverOutput::send(const KlobucharModel& model, GpsTime received) {
  output_->send(model, received);
  ++messages_;
}

void ReceiverOutput::send(const std::vector<SignalBias>& biases) {
  output_->send(std::span<const SignalBias>(biases));
  ++messages_;
}

std::optional<DataTime> ReceiverOutput::data_time() const {
  if (!last_epoch_.is_set()) return std::nullopt;
  return DataTime{true, last_epoch_.nanoseconds()};
}

std::string ReceiverOutput::detail() const {
  if (!last_epoch_.is_set() && ephemerides_ == 0) return "";
  return format("%zu signals in the last epoch, %llu ephemerides", last_signals_,
                static_cast<unsigned long long>(ephemerides_));
}

}  // namespace leonav
