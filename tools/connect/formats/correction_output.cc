#include "tools/connect/formats/correction_output.h"

#include <span>
#include <vector>

#include "tools/common/format.h"

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

std::string CorrectionOutput::detail() const {
  if (last_satellites_ == 0) return "";
  const CorrectionServices& services = shared_->services;
  const CorrectionCounters c = services.counters(stream_);
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
  const std::pair<const char*, std::uint64_t> reasons[] = {
      {"without their ephemeris", c.without_ephemeris},
      {"of BeiDou without their ephemeris of B-CNAV1 (turn on B1C)", c.without_bcnav1},
      {"without orbit", c.without_orbit},
      {"without clock", c.without_clock},
      {"of two solutions", c.of_other_issue},
      {"too old", c.too_old},
      {"that the service does not vouch for", c.not_reliable},
      {"in a regional frame", c.in_regional_frame}};
  const char* separator = "; not used since the start: ";
  for (const auto& [reason, count] : reasons) {
    if (count == 0) continue;
    text += separator + std::to_string(count) + " " + reason;
    separator = ", ";
  }
  return text;
}

}  // namespace leonav
