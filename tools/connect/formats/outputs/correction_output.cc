#include "tools/connect/formats/outputs/correction_output.h"

#include <span>
#include <vector>

#include "tools/common/format.h"
#include "tools/import/unused_corrections.h"

namespace leonav {
namespace {

// A question, or what must change, in the words of connect.yaml.
const char* remedy_of(UnusedReason reason) {
  switch (reason) {
    case UnusedReason::kWithoutEphemeris:
      return "ephemerides must come too, from a receiver or another stream; in RTCM 3 these are "
             "1019, 1042, 1045 or 1046";
    case UnusedReason::kWithoutBcnav1:
      return "the receiver must give B1C, whose B-CNAV1 has the ephemerides that are corrected";
    case UnusedReason::kTooOld:
      return "they come later than 'max_orbit_age_s' and 'max_clock_age_s' allow, by the "
             "receiver's time, or by the host's clock where no receiver is connected: is the "
             "host's clock right, and how old is what the service sends?";
    case UnusedReason::kInRegionalFrame:
      return "choose a stream of the service in the ITRF";
    case UnusedReason::kWithoutOrbit:
    case UnusedReason::kWithoutClock:
    case UnusedReason::kOfOtherIssue:
    case UnusedReason::kNotReliable:
      break;
  }
  return "the service sends no complete solution of these satellites; ask its operator if it lasts";
}

}  // namespace

int CorrectionOutput::take(const SsrMessage& message, GpsTime now) {
  const CorrectionResult result = shared_->services.take(stream_, message, now);
  if (has_clocks(message)) {
    last_usable_ = result.usable_states;
    last_satellites_ = message.satellites.size();
  }
  int published = result.is_left_out ? 1 : 0;
  // Not counted: a service sends biases also while none of its corrections can be used.
  if (!result.biases.empty()) {
    const std::span<const SignalBias> biases(result.biases);
    if (shared_->on_biases) shared_->on_biases(biases);
    shared_->output->send(biases);
  }
  if (!result.states.empty()) {
    shared_->output->send(std::span<const CorrectedState>(result.states), result.source);
    shared_->output->note_time(now);
    for (const CorrectedState& state : result.states) {
      shared_->output->note_orbit(state.satellite, state.time);
    }
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
    remedy = remedy_of(unused.reason);
  }
  const std::string what = detail();  // empty where no message had satellites with clocks
  return "none can be used" + (what.empty() ? "" : " (" + what + ")") + ": " + remedy;
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
