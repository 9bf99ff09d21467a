#include "tools/import/unused_corrections.h"

namespace leonav {

std::vector<UnusedCorrections> unused_corrections(const CorrectionCounters& c) {
  using enum UnusedReason;
  return {{kWithoutEphemeris, c.without_ephemeris,
           "correction of a broadcast message that is not there", "without their ephemeris"},
          {kWithoutBcnav1, c.without_bcnav1,
           "correction of BeiDou whose ephemeris of B-CNAV1 is not there (let the receiver give "
           "B1C)",
           "of BeiDou without their ephemeris of B-CNAV1 (turn on B1C)"},
          {kWithoutOrbit, c.without_orbit, "corrected clock of a satellite without corrected orbit",
           "without orbit"},
          {kWithoutClock, c.without_clock,
           "corrected orbit of a satellite whose clock belongs to another issue", "without clock"},
          {kOfOtherIssue, c.of_other_issue,
           "correction whose orbit and clock are of different solutions", "of two solutions"},
          {kTooOld, c.too_old, "correction that is too old", "too old"},
          {kNotReliable, c.not_reliable, "correction that the service does not vouch for",
           "that the service does not vouch for"},
          {kInRegionalFrame, c.in_regional_frame, "correction in a regional frame",
           "in a regional frame"}};
}

}  // namespace leonav
