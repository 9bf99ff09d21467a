#include "tools/import/unused_corrections.h"

namespace leonav {

std::vector<UnusedCorrections> unused_corrections(const CorrectionCounters& c) {
  constexpr const char* kEphemerides =
      "ephemerides must come too, 1019, 1042, 1045 or 1046 in this stream or from a receiver";
  constexpr const char* kAskService =
      "the service sends no complete solution of these satellites; ask its operator if it lasts";
  return {
      {c.without_ephemeris, "correction of a broadcast message that is not there",
       "without their ephemeris", kEphemerides},
      {c.without_bcnav1,
       "correction of BeiDou whose ephemeris of B-CNAV1 is not there (let the receiver give "
       "B1C)",
       "of BeiDou without their ephemeris of B-CNAV1 (turn on B1C)",
       "the receiver must give B1C, whose B-CNAV1 has the ephemerides that are corrected"},
      {c.without_orbit, "corrected clock of a satellite without corrected orbit", "without orbit",
       kAskService},
      {c.without_clock, "corrected orbit of a satellite whose clock belongs to another issue",
       "without clock", kAskService},
      {c.of_other_issue, "correction whose orbit and clock are of different solutions",
       "of two solutions", kAskService},
      {c.too_old, "correction that is too old", "too old",
       "they come later than 'max_orbit_age_s' and 'max_clock_age_s' allow, by the receiver's "
       "time, or by the host's clock where no receiver is connected: is the host's clock right, "
       "and how old is what the service sends?"},
      {c.not_reliable, "correction that the service does not vouch for",
       "that the service does not vouch for", kAskService},
      {c.in_regional_frame, "correction in a regional frame", "in a regional frame",
       "choose a stream of the service in the ITRF"}};
}

}  // namespace leonav
