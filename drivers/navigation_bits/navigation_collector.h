// The NavigationCollector makes ephemerides of the subframes of all satellites, whatever format a
// receiver hands them out in.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "drivers/binary/cnav_delays.h"
#include "drivers/binary/reported_ephemerides.h"
#include "drivers/navigation_bits/beidou_d1.h"
#include "drivers/navigation_bits/beidou_d2.h"
#include "drivers/navigation_bits/galileo_fnav.h"
#include "drivers/navigation_bits/galileo_inav.h"
#include "drivers/navigation_bits/gps_lnav.h"
#include "drivers/navigation_bits/navigation_frame.h"

namespace leonav {

// Counts of subframes and ephemerides.
struct NavigationCounters {
  std::uint64_t subframes = 0;        // understood and used
  std::uint64_t other_message = 0;    // a navigation message leonav does not read (almanacs, ...)
  std::uint64_t bad_parity = 0;       // parity or CRC wrong, or the fixed bits are not there
  std::uint64_t bad_week = 0;         // its week number contradicts the receiver's
  std::uint64_t wrong_satellite = 0;  // it names another satellite than the receiver does
  std::uint64_t not_sane = 0;         // decoded elements outside physical bounds
  std::uint64_t ephemerides = 0;
  std::uint64_t delays = 0;  // sets of group delays of a satellite
};

// There is one collector per satellite and message. An ephemeris is given when it is complete and
// differs from the last one given for its satellite and message. Precondition of every function:
// the satellite's number is below kSatellites.
class NavigationCollector {
 public:
  static constexpr std::size_t kSatellites = 64;

  NavigationUpdate add_gps_lnav(std::span<const std::uint32_t, GpsLnav::kWords> words,
                                const SubframeOrigin& origin);
  NavigationUpdate add_galileo_inav(std::span<const std::uint32_t, GalileoInav::kWords> words,
                                    const SubframeOrigin& origin);
  NavigationUpdate add_galileo_fnav(std::span<const std::uint32_t, GalileoFnav::kWords> words,
                                    const SubframeOrigin& origin);
  // D1 or D2, by the satellite's orbit.
  NavigationUpdate add_beidou(std::span<const std::uint32_t, kBeidouWords> words,
                              const SubframeOrigin& origin);
  // The group delays of a message of GPS CNAV, BeiDou B-CNAV1 (its subframe 2, whose elements are
  // given too) or B-CNAV2, whose bits begin with the first byte's highest one. They are given when
  // they have changed, and again every hour, so that a program that starts later gets them.
  NavigationUpdate add_gps_cnav(std::span<const std::uint8_t> bits, const SubframeOrigin& origin);
  NavigationUpdate add_bcnav1(std::span<const std::uint8_t> bits, const SubframeOrigin& origin);
  NavigationUpdate add_bcnav2(std::span<const std::uint8_t> bits, const SubframeOrigin& origin);
  void count_other_message() { ++counters_.other_message; }
  // Returns whether a set that the receiver itself has decoded is sane and a new one; counts it.
  bool take_decoded(const Ephemeris& ephemeris) { return is_new_issue(ephemeris); }

  const NavigationCounters& counters() const { return counters_; }

 private:
  NavigationUpdate finish(SubframeStatus status, NavigationUpdate update);
  NavigationUpdate finish_delays(CnavStatus status, std::vector<SignalBias> biases, GpsTime now);
  bool are_new(const std::vector<SignalBias>& biases, GpsTime now);
  void count(SubframeStatus status);
  bool is_new_issue(const Ephemeris& ephemeris);

  NavigationCounters counters_;
  // By the satellite's number, made when its first subframe comes.
  std::map<std::size_t, GpsLnav> gps_lnav_;
  std::map<std::size_t, GalileoInav> galileo_inav_;
  std::map<std::size_t, GalileoFnav> galileo_fnav_;
  std::map<std::size_t, BeidouD1> beidou_d1_;
  std::map<std::size_t, BeidouD2> beidou_d2_;
  ReportedEphemerides reported_;
  // Of each satellite's signal the delay given last, and when.
  std::map<std::pair<SatelliteId, SignalCode>, std::pair<double, GpsTime>> reported_delays_;
};

}  // namespace leonav
