#include "tools/connect/formats/outputs/receiver_output.h"

#include "tools/common/format.h"
#include "tools/import/product_schedule.h"

namespace leonav {
namespace {

// A receiver that is off for longer starts anew, and need not know the time at first.
constexpr double kLongestGap_s = 86'400.0;

}  // namespace

// Epochs that go back, or forward by more than a day, are those of a receiver whose time was wrong
// before or is wrong now, as after a start without a fix.
void ReceiverOutput::note_step(GpsTime time) {
  if (!last_epoch_.is_set()) return;
  const double step_s = seconds_between(time, last_epoch_);
  if (step_s >= 0.0 && step_s < kLongestGap_s) return;
  ++time_steps_;
  monitor_.start_over();
  last_step_s_ = step_s;
}

void ReceiverOutput::send(const RawEpoch& epoch, std::int64_t arrival_ns, bool has_own_week) {
  clock_->on_epoch(epoch.time, arrival_ns);
  if (has_own_week) clock_->confirm_host(epoch.time, arrival_ns);
  note_step(epoch.time);
  last_epoch_ = epoch.time;
  last_signals_ = epoch.observations.size();
  monitor_.on_epoch(epoch);
  output_->send(epoch);
  output_->note_time(epoch.time);
  ++messages_;
  ++(epoch.observations.empty() ? empty_epochs_ : epochs_);
  repeat_navigation(epoch.time);
}

void ReceiverOutput::repeat_navigation(GpsTime now) {
  messages_ += static_cast<std::uint64_t>(repeater_.repeat(now));
}

void ReceiverOutput::send(const Ephemeris& ephemeris, GpsTime received) {
  Ephemeris sent = ephemeris;
  sent.transmission_time = transmission_time(ephemeris);
  if (is_for_corrections_alone(sent)) {
    if (corrections_ != nullptr) corrections_->add(sent);
    return;
  }
  output_->send(sent);
  output_->note_orbit(sent.satellite, sent.toe);
  if (corrections_ != nullptr) corrections_->add(sent);
  if (!received.is_set()) received = sent.transmission_time;
  repeater_.remember(sent, last_epoch_.is_set() ? last_epoch_ : received);
  ++messages_;
  ++ephemerides_;
}

void ReceiverOutput::send(const KlobucharModel& model, GpsTime received) {
  output_->send(model, received);
  repeater_.remember(model, last_epoch_);
  ++messages_;
}

void ReceiverOutput::send(const std::vector<SignalBias>& biases) {
  output_->send(std::span<const SignalBias>(biases));
  repeater_.remember(biases, last_epoch_);
  ++messages_;
}

std::optional<DataTime> ReceiverOutput::data_time() const {
  if (!last_epoch_.is_set()) return std::nullopt;
  return DataTime{true, last_epoch_.nanoseconds()};
}

std::string ReceiverOutput::detail() const {
  if (!last_epoch_.is_set() && ephemerides_ == 0) return "";
  // A service of corrections sends no epochs.
  std::string text;
  if (last_epoch_.is_set()) text = format("%zu signals in the last epoch, ", last_signals_);
  text += format("%llu ephemerides", static_cast<unsigned long long>(ephemerides_));
  if (time_steps_ > 0) {
    text += format("; its time has stepped %llu times, the last by %.0f s",
                   static_cast<unsigned long long>(time_steps_), last_step_s_);
  }
  const std::string missing = monitor_.text();
  if (!missing.empty()) text += "; " + missing;
  return text;
}

}  // namespace leonav
