// This unit holds a satellite's carrier, or pair of carriers, at one epoch, as given and in metres.
#pragma once
#include <array>

#include "core/gnss/signals/band_plan.h"
#include "core/gnss/signals/observation.h"

namespace leonav {

// One satellite's carrier, or its pair of carriers. A satellite whose pair is incomplete at one
// epoch is better left out of that epoch: its arc survives a short gap, while a pair that becomes a
// single carrier has another ambiguity.
struct CarrierInput {
  const SignalObservation* first = nullptr;   // must have a carrier; otherwise the input is ignored
  const SignalObservation* second = nullptr;  // nullptr or without carrier: single frequency
  double elevation = 0.0;                     // rad; 0 or NaN if not known: lowest weight
};

// One signal at the current epoch, in metres.
struct CarrierSignal {
  SignalCode code;
  double frequency_hz = 0.0;
  double wavelength_m = 0.0;
  double carrier_m = kNotMeasured;    // as measured
  double code_m = kNotMeasured;       // without the jumps of the receiver's clock
  double doppler_m_s = kNotMeasured;  // as range rate: positive when the range grows
  double lock_time_s = kNotMeasured;
  bool loss_of_lock = false;
  bool half_cycle_ambiguous = false;
  double repair_m = 0.0;  // half cycles repaired since the arc began
};

// One satellite's carriers at one epoch, in metres.
struct CarrierSample {
  GpsTime time;
  double elevation = 0.0;        // rad
  double carrier_shift_m = 0.0;  // shift that makes carriers continuous over clock jumps
  int signal_count = 0;          // 1 or 2
  std::array<CarrierSignal, 2> signal;

  double carrier(int i) const {
    const CarrierSignal& s = signal[static_cast<std::size_t>(i)];
    return s.carrier_m + s.repair_m + carrier_shift_m;
  }
};

// Returns whether the input can be followed: it has a carrier of a known satellite and signal.
bool has_carrier(const CarrierInput& input, const BandPlan& bands);

// Converts an input that has a carrier. `shift_m` is the sum of the jumps of codes against carriers
// since the start of the run; it is removed from the codes and added by carrier().
CarrierSample carrier_sample(const CarrierInput& input, const BandPlan& bands, GpsTime time,
                             double shift_m);

}  // namespace leonav
