#include "tools/connect/formats/correction_output.h"

#include <span>
#include <vector>

#include "tools/common/format.h"

namespace leonav {

int CorrectionOutput::take(const SsrMessage& message, GpsTime now) {
  int published = 0;
  store_.add(message);
  if (has_clocks(message)) {
    const std::vector<CorrectedState> states = store_.states(message, now);
    last_states_ = states.size();
    last_satellites_ = message.satellites.size();
    if (!states.empty()) {
      output_->send(std::span<const CorrectedState>(states), source_of(message));
      output_->note_time(now);
      ++published;
    }
  }
  const std::vector<SignalBias> biases = biases_of(message, now);
  // Not counted: a service sends biases also while none of its corrections can be used.
  if (!biases.empty()) output_->send(std::span<const SignalBias>(biases));
  return published;
}

std::string CorrectionOutput::detail() const {
  if (last_satellites_ == 0) return "";
  const CorrectionCounters& c = store_.counters();
  std::string text =
      format("corrections of %zu satellites, used of %zu", last_satellites_, last_states_);
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
