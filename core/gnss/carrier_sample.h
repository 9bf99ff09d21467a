// A satellite's carrier, or pair of carriers, at one epoch: as given, and in metres.
#pragma once
#include <array>

#include "core/gnss/observation.h"

namespace leonav {

// One satellite's carrier, or pair of carriers if it is to be used as a pair. A satellite whose
// pair is incomplete at one epoch is better left out of that epoch: its arc survives a short gap,
// while a pair that turns into a single carrier is another ambiguity.
struct CarrierInput {
  const SignalObservation* first = nullptr;   // must have a carrier; otherwise the input is ignored
  const SignalObservation* second = nullptr;  // nullptr or without carrier: single frequency
  double elevation = 0.0;                     // rad; 0 or NaN if not known: lowest weight
};

// One signal at the epoch under way, in metres.
struct CarrierSide {
  SignalCode code;
  double frequency_hz = 0.0;
  double wavelength_m = 0.0;
  double carrier_m = kNotMeasured;    // as measured
  double code_m = kNotMeasured;       // without what the receiver's clock has jumped
  double doppler_m_s = kNotMeasured;  // as range rate: positive when the range grows
  double lock_time_s = kNotMeasured;
  bool loss_of_lock = false;
  bool half_cycle_ambiguous = false;
  double repair_m = 0.0;  // half cycles repaired since the arc began
};

struct CarrierSample {
  GpsTime time;
  double elevation = 0.0;        // rad
  double carrier_shift_m = 0.0;  // what makes carriers continuous over the clock's jumps
  int sides = 0;                 // 1 or 2
  std::array<CarrierSide, 2> side;

  double carrier(int i) const {
    const CarrierSide& s = side[static_cast<std::size_t>(i)];
    return s.carrier_m + s.repair_m + carrier_shift_m;
  }
};

// Whether the input can be followed: a satellite and signal that are known, with a carrier.
bool has_carrier(const CarrierInput& input);

// Of an input that has a carrier. `shift_m`: by which codes have jumped against carriers since the
// start of the run; it is taken out of the codes, and carrier() has it on top.
CarrierSample carrier_sample(const CarrierInput& input, GpsTime time, double shift_m);

}  // namespace leonav
