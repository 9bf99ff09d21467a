#include "core/gnss/preprocessing/internal/carrier_selection.h"

#include <cmath>

namespace leonav {
namespace {

const SignalObservation* on_band_of(std::span<const SignalObservation> observations,
                                    const SignalObservation* signal) {
  if (signal == nullptr || std::isfinite(signal->carrier_cycles)) return signal;
  for (const SignalObservation& other : observations) {
    if (other.code.band == signal->code.band && std::isfinite(other.carrier_cycles)) return &other;
  }
  return nullptr;
}

const SignalObservation* of_code(std::span<const SignalObservation> observations, SignalCode code,
                                 double cn0_mask_dbhz) {
  for (const SignalObservation& signal : observations) {
    const bool weak = signal.cn0_dbhz < cn0_mask_dbhz;  // NaN, not measured: not weak
    if (signal.code == code && std::isfinite(signal.carrier_cycles) && !weak) return &signal;
  }
  return nullptr;
}

}  // namespace

CarrierChoice choose_carriers(std::span<const SignalObservation> observations,
                              const SelectedSignals& signals, double cn0_mask_dbhz,
                              const CarrierPairCodes* tracked) {
  CarrierChoice choice;
  const bool pair = tracked != nullptr || signals.second != nullptr;
  if (tracked != nullptr) {
    choice.first = of_code(observations, tracked->first, cn0_mask_dbhz);
    choice.second = of_code(observations, tracked->second, cn0_mask_dbhz);
  } else {
    choice.first = on_band_of(observations, signals.first);
    choice.second = on_band_of(observations, signals.second);
  }
  if (choice.first == nullptr || (pair && choice.second == nullptr)) return {};
  return choice;
}

}  // namespace leonav
