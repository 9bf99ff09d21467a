#include "core/gnss/cycle_slips/internal/carrier_sample.h"

#include <cmath>

namespace leonav {
namespace {

CarrierSignal signal_of(const SignalObservation& observation, const BandPlan& bands,
                        double code_shift_m) {
  CarrierSignal signal;
  signal.code = observation.code;
  signal.frequency_hz = bands.frequency_hz(observation.satellite.system, observation.code.band);
  signal.wavelength_m = bands.wavelength_m(observation.satellite.system, observation.code.band);
  signal.carrier_m = observation.carrier_cycles * signal.wavelength_m;
  signal.code_m = observation.pseudorange_m - code_shift_m;
  signal.doppler_m_s = -observation.doppler_hz * signal.wavelength_m;
  signal.lock_time_s = observation.lock_time_s;
  signal.loss_of_lock = observation.loss_of_lock;
  signal.half_cycle_ambiguous = observation.half_cycle_ambiguous;
  return signal;
}

bool is_usable(const SignalObservation* observation, const BandPlan& bands) {
  return observation != nullptr && std::isfinite(observation->carrier_cycles) &&
         index_of(observation->satellite.system) < kSystemCount &&
         bands.frequency_hz(observation->satellite.system, observation->code.band) > 0.0;
}

bool is_pair(const CarrierInput& input, const BandPlan& bands) {
  return is_usable(input.second, bands) && input.second->satellite == input.first->satellite &&
         bands.frequency_hz(input.first->satellite.system, input.first->code.band) !=
             bands.frequency_hz(input.first->satellite.system, input.second->code.band);
}

}  // namespace

bool has_carrier(const CarrierInput& input, const BandPlan& bands) {
  return is_usable(input.first, bands) && is_valid(input.first->satellite);
}

CarrierSample carrier_sample(const CarrierInput& input, const BandPlan& bands, GpsTime time,
                             double shift_m) {
  CarrierSample sample;
  sample.time = time;
  sample.elevation = std::isfinite(input.elevation) ? input.elevation : 0.0;
  sample.signal_count = is_pair(input, bands) ? 2 : 1;
  sample.signal[0] = signal_of(*input.first, bands, shift_m);
  if (sample.signal_count == 2) sample.signal[1] = signal_of(*input.second, bands, shift_m);
  sample.carrier_shift_m = shift_m;
  return sample;
}

}  // namespace leonav
