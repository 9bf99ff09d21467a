// This unit keeps the biases of satellites' signals that a product gives beside its clocks. Its
// capacity is fixed and it allocates only at construction.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>

#include "core/base/gps_time.h"
#include "core/gnss/propagation/group_delay.h"
#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav {

// What a bias is added to, and which clock it refers to. On the wire: append only.
enum class BiasKind : std::uint8_t {
  kCode = 0,           // a code, against the clock of a product of precise or corrected states
  kPhase = 1,          // a carrier, against the same
  kBroadcastCode = 2,  // a code, against the clock of the broadcast message (CNAV's ISC and TGD)
};

// Bias of one signal of one satellite against a clock (observable-specific bias, SINEX BIAS 1.00):
// to be subtracted from the measured code or carrier.
struct SignalBias {
  SatelliteId satellite;
  SignalCode code;
  BiasKind kind = BiasKind::kCode;
  GpsTime time;         // when it was received
  double bias_m = 0.0;  // m
  // The bias holds in valid_from <= t < valid_until. Either may be unset: without a beginning it
  // holds at once, without an end until kLongestBiasAge_s after `time`.
  GpsTime valid_from = {}, valid_until = {};
};

// Whether the values are those of a bias that a satellite can have: a valid satellite, a signal of
// its system, a time, at most kLargestBias_m, an end after the beginning.
bool is_sane(const SignalBias& bias);

inline constexpr double kLargestBias_m = 1000.0;
// Biases change within days; a service sends them every few minutes at least.
inline constexpr double kLongestBiasAge_s = 86400.0;

// SignalBiasStore holds the code biases of all satellites, those against the clock of a product
// apart from those against the broadcast one; those of carriers are accepted and not kept.
class SignalBiasStore {
 public:
  // `bands`: the carriers of the LEO satellites.
  explicit SignalBiasStore(const BandPlan& bands = {});
  ~SignalBiasStore();
  SignalBiasStore(SignalBiasStore&&) noexcept;
  SignalBiasStore& operator=(SignalBiasStore&&) noexcept;

  // Returns false (and changes nothing) if the bias is not sane. A bias replaces that of the same
  // signal and beginning of validity, so that those of the next day can come ahead. Where a
  // satellite has kMaxIntervals * kMaxSignalBiases others, it replaces one whose end has passed at
  // the bias' time, else the one that arrived first. Beyond kMaxProductBiases of all satellites, or
  // kMaxBroadcastBiases of the others, a satellite with most loses the one that arrived first. What
  // served within the last minute makes room last.
  bool add(const SignalBias& bias);
  static constexpr std::size_t kMaxIntervals = 2;

  // Returns whether one of the same satellite, signal and kind is kept that holds at `bias.time`.
  // Of carriers none is needed: true.
  bool has(const SignalBias& bias) const;
  // Returns how many satellites of its system have one of the same signal and kind.
  std::size_t count_in_system(const SignalBias& bias) const;

  // Returns the delay at `time` against the clock of the product, of the signal `first` or, with
  // `second`, of the ionosphere-free pair; nullopt where a signal has no bias that holds then. Of
  // several the one that arrived last counts.
  std::optional<GroupDelay> code_delay(SatelliteId satellite, GpsTime time, SignalCode first,
                                       SignalCode second = {}) const;
  // Returns the same against the clock of the broadcast message, of biases kBroadcastCode.
  std::optional<GroupDelay> broadcast_delay(SatelliteId satellite, GpsTime time, SignalCode first,
                                            SignalCode second = {}) const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
