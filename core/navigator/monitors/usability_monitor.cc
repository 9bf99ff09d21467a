#include "core/navigator/monitors/usability_monitor.h"

namespace leonav {
namespace {

constexpr int kEpochsToTell = 5;  // one or two epochs may be a burst of interference

bool is_expected(Reason reason) {
  return reason == Reason::kSystemDisabled || reason == Reason::kLowElevation;
}

}  // namespace

std::optional<UsabilityMonitor::Finding> UsabilityMonitor::add(
    std::span<const SatelliteReport> satellites) {
  Finding finding;
  bool one_reason = true;
  for (const SatelliteReport& satellite : satellites) {
    if (is_expected(satellite.reason)) continue;
    if (finding.satellites == 0) finding.reason = satellite.reason;
    one_reason = one_reason && satellite.reason == finding.reason;
    ++finding.satellites;
  }
  if (finding.satellites == 0 || !one_reason || is_used(finding.reason)) {
    epochs_ = 0;
    return std::nullopt;
  }
  epochs_ = finding.reason == reason_ ? epochs_ + 1 : 1;
  reason_ = finding.reason;
  if (epochs_ != kEpochsToTell) return std::nullopt;
  return finding;
}

}  // namespace leonav
