// This unit decodes UBX-RXM-SFRBX (0x02 0x13), broadcast subframes, to ephemerides, ionosphere
// coefficients and group delays. Source: u-blox ZED-F9P interface description UBX-22008968,
// sections 1.5 and 3.17.9.
#pragma once
#include <cstdint>
#include <memory>
#include <span>

#include "drivers/ubx/navigation_frame.h"

namespace leonav {

// Counts of subframes and ephemerides.
struct RxmSfrbxCounters {
  std::uint64_t subframes = 0;  // understood and used
  std::uint64_t bad_length = 0;
  std::uint64_t bad_version = 0;
  std::uint64_t bad_satellite = 0;
  std::uint64_t other_system = 0;  // SBAS, QZSS, GLONASS, IMES, NavIC
  std::uint64_t other_message =
      0;                         // a navigation message leonav does not read (E6-B, almanacs, ...)
  std::uint64_t bad_parity = 0;  // parity or CRC wrong, or the fixed bits are not there
  std::uint64_t bad_week = 0;    // its week number contradicts the receiver's
  std::uint64_t wrong_satellite = 0;  // it names another satellite than the receiver does
  std::uint64_t without_time = 0;     // received before a RAWX had given the week
  std::uint64_t not_sane = 0;         // decoded elements outside physical bounds
  std::uint64_t ephemerides = 0;
  std::uint64_t delays = 0;  // sets of group delays of a satellite
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
  const RxmSfrbxCounters& counters() const { return counters_; }

 private:
  SubframeStatus add(std::uint8_t signal_id, std::span<const std::uint32_t> words,
                     const SubframeOrigin& origin, NavigationUpdate* update);
  void count(SubframeStatus status);
  bool is_new_issue(const Ephemeris& ephemeris);
  bool are_new(const std::vector<SignalBias>& biases, GpsTime now);

  struct State;
  RxmSfrbxCounters counters_;
  std::unique_ptr<State> state_;
};

}  // namespace leonav
