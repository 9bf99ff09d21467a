// This unit maps NovAtel's numbers of systems and signals to leonav's types.
#pragma once
#include <cstdint>
#include <optional>

#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// The word that RANGE and RANGECMP hold of each channel. Source: OEM7 manual, RANGE, table "Channel
// Tracking Status".
class TrackingStatus {
 public:
  explicit constexpr TrackingStatus(std::uint32_t word) : word_(word) {}

  constexpr bool phase_is_locked() const { return bit(10); }
  constexpr bool parity_is_known() const { return bit(11); }
  constexpr bool code_is_locked() const { return bit(12); }
  constexpr bool half_cycle_is_added() const { return bit(28); }
  // nullopt: a system that leonav does not use (GLONASS, SBAS, QZSS, NavIC, L-band).
  std::optional<System> system() const;
  // nullopt: a signal without a RINEX 3.04 code. Precondition: system() is one.
  std::optional<SignalCode> signal() const;

 private:
  constexpr bool bit(int number) const { return ((word_ >> number) & 1u) != 0; }
  std::uint32_t word_;
};

// The numbers of systems in RANGECMP2 and RANGECMP4, which are not those of the tracking status.
inline constexpr std::uint32_t kCompressedGlonass = 1;
std::optional<System> system_from_compressed(std::uint32_t number);

// Return the code of a signal's number in RANGECMP2, or in RANGECMP4; they differ for BeiDou.
std::optional<SignalCode> signal_from_rangecmp2(System system, std::uint32_t number);
std::optional<SignalCode> signal_from_rangecmp4(System system, std::uint32_t number);

}  // namespace leonav
