#include "tools/connect/formats/outputs/correction_output.h"

#include <span>
#include <vector>

#include "tools/common/format.h"
#include "tools/import/unused_corrections.h"

namespace leonav {

int CorrectionOutput::take(const SsrMessage& message, GpsTime now) {
  const CorrectionResult result = shared_->services.take(stream_, message, now);
  if (has_clocks(message)) {
    last_usable_ = result.usable_states;
    last_satellites_ = message.satellites.size();
  }
  int published = result.is_left_out ? 1 : 0;
  // Not counted: a service sends biases also while none of its corrections can be used.
  if (!result.biases.empty()) {
    shared_->output->send(std::span<const SignalBias>(result.biases));
  }
  if (!result.states.empty()) {
    shared_->output->send(std::span<const CorrectedState>(result.states), result.source);
    shared_->output->note_time(now);
    ++published;
  }
  if (result.change && shared_->on_change) shared_->on_change(*result.change);
  return published;
}

std::string CorrectionOutput::why_none() const {
  std::string remedy = "is it the stream of a service for GPS, Galileo or BeiDou?";
  std::uint64_t most = 0;
  for (const UnusedCorrections& unused : unused_corrections(shared_->services.counters(stream_))) {
    if (unused.count <= most) continue;
    most = unused.count;
    remedy = unused.remedy;
  }
  return "none can be used (" + detail() + "): " + remedy;
}

std::string CorrectionOutput::detail() const {
  if (last_satellites_ == 0) return "";
  const CorrectionServices& services = shared_->services;
  std::string text = format("corrections of %zu satellites, %s of %zu", last_satellites_,
                            services.services() > 1 ? "usable" : "used", last_usable_);
  if (services.services() > 1) {
    const std::string systems = services.systems_of(stream_);
    text += systems.empty() ? ", in reserve behind another service" : ", in use for " + systems;
    if (services.changes() > 0) {
      text += format(", changes of services: %llu",
                     static_cast<unsigned long long>(services.changes()));
    }
  }
  const char* separator = "; not used since the start: ";
  for (const UnusedCorrections& unused : unused_corrections(services.counters(stream_))) {
    if (unused.count == 0) continue;
    text += separator + std::to_string(unused.count) + " " + unused.many;
    separator = ", ";
  }
  return text;
}

}  // namespace leonav
