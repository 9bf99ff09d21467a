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

// What a bias is added to. On the wire: append only.
enum class BiasKind : std::uint8_t { kCode = 0, kPhase = 1 };

// Bias of one signal of one satellite against the clock of the product (observable-specific bias,
// SINEX BIAS 1.00): to be subtracted from the measured code or carrier.
struct SignalBias {
  SatelliteId satellite;
  SignalCode code;
  BiasKind kind = BiasKind::kCode;
  GpsTime time;         // when it was received
  double bias_m = 0.0;  // m
};

// Whether the values are those of a bias that a satellite can have: a valid satellite, a signal of
// its system, a time, at most kLargestBias_m.
bool is_sane(const SignalBias& bias);

inline constexpr double kLargestBias_m = 1000.0;
// Biases change within days; a service sends them every few minutes at least.
inline constexpr double kLongestBiasAge_s = 86400.0;

// SignalBiasStore holds the code biases of all satellites; those of carriers are accepted and not
// kept.
class SignalBiasStore {
 public:
  // `bands`: the carriers of the LEO satellites.
  explicit SignalBiasStore(const BandPlan& bands = {});
  ~SignalBiasStore();
  SignalBiasStore(SignalBiasStore&&) noexcept;
  SignalBiasStore& operator=(SignalBiasStore&&) noexcept;

  // Returns false (and changes nothing) if the bias is not sane. A bias replaces that of the same
  // signal; where a satellite has kMaxSignalBiases others, the one that arrived first.
  bool add(const SignalBias& bias);

  // Returns the delay at `time` against the clock of the product, of the signal `first` or, with
  // `second`, of the ionosphere-free pair; nullopt where a signal has no bias of the last
  // kLongestBiasAge_s.
  std::optional<GroupDelay> code_delay(SatelliteId satellite, GpsTime time, SignalCode first,
                                       SignalCode second = {}) const;

 private:
  struct Storage;
  std::unique_ptr<Storage> storage_;
};

}  // namespace leonav
