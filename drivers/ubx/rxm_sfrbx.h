// This unit decodes UBX-RXM-SFRBX (0x02 0x13), broadcast subframes, to ephemerides, ionosphere
// coefficients, group delays and pages of corrections. Source: u-blox ZED-F9P interface description
// UBX-22008968,
// sections 1.5 and 3.17.9.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "drivers/navigation_bits/navigation_collector.h"

namespace leonav {

// Counts of subframes and ephemerides.
struct RxmSfrbxCounters : NavigationCounters {
  std::uint64_t pages = 0;  // of corrections (Galileo E6-B), passed on
  std::uint64_t bad_length = 0;
  std::uint64_t bad_version = 0;
  std::uint64_t bad_satellite = 0;
  std::uint64_t other_system = 0;  // SBAS, QZSS, GLONASS, IMES, NavIC
  std::uint64_t without_time = 0;  // no RAWX has given the time, or none for too long
};

// The decoder collects the subframes of every satellite. It reports an ephemeris when it is
// complete and differs from the last one reported for its satellite and message, and the group
// delays of CNAV and B-CNAV when they differ or the last report is an hour old.
class RxmSfrbxDecoder {
 public:
  RxmSfrbxDecoder();
  ~RxmSfrbxDecoder();
  // Takes one message. `now` is the time of the last RAWX, which completes truncated week numbers;
  // unset if there was none.
  NavigationUpdate decode(std::span<const std::uint8_t> payload, GpsTime now);
  RxmSfrbxCounters counters() const;

 private:
  NavigationUpdate add(std::uint8_t signal_id, std::span<const std::uint32_t> words,
                       const SubframeOrigin& origin);
  NavigationUpdate add_page(std::span<const std::uint32_t> words, const SubframeOrigin& origin);

  RxmSfrbxCounters counters_;  // without the collector's part
  std::uint64_t bad_pages_ = 0;
  std::unique_ptr<NavigationCollector> collector_;
};

}  // namespace leonav
