// This unit turns differences between the code biases of a satellite into biases against a clock.
#pragma once
#include <map>
#include <span>
#include <vector>

#include "drivers/bias_sinex/bias_record.h"

namespace leonav {

// The codes that the satellite clocks of a product refer to: their ionosphere-free pair has no
// delay, or, without a second, the one code.
struct ClockReference {
  SignalCode first, second;
};

// Returns those of the IGS' products, in order of preference: GPS C1W/C2W; Galileo C1C/C5Q, for
// receivers that track the pilot alone, or C1X/C5X; BeiDou C2I/C6I. LEO: none.
std::vector<ClockReference> usual_references(System system);

struct DifferenceResult {
  std::vector<BiasRecord> biases;       // OSBs, in order of code and time
  std::vector<SignalCode> unconnected;  // codes that no differences connect to a reference
};

// Computes the biases of one satellite. `differences` are its DSBs; in each interval in which they
// hold together, codes connected by differences to both codes of a reference have
//   b_k - b_l = DSB(k, l),   gamma_1 b_first + gamma_2 b_second = 0,
// gamma_1 = f_1^2 / (f_1^2 - f_2^2), gamma_2 = 1 - gamma_1. Where the differences close a loop, the
// path of fewest differences counts. Neighbouring intervals with the same value are one.
DifferenceResult resolve_differences(std::span<const BiasRecord> differences,
                                     std::span<const ClockReference> references);

}  // namespace leonav
