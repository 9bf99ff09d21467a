// The filter's nominal state as a whole, and its error state's two operations: add and difference.
#pragma once
#include "core/filter/state/ekf_state.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

// Beside the gyros' noise, until then: an attitude that was found, not told, is wrong in ways that
// its variances do not tell of.
struct AttitudeRandomWalk {
  double noise = 0.0;  // rad/sqrt(s)
  GpsTime until;
};

struct FilterState {
  NavState nav;
  ClockState clocks;
  double wet_delay_m = 0.0;      // at zenith, beyond the modelled one
  double carrier_clock_m = 0.0;  // of the carriers against the codes
  VehicleConstants vehicle;
  Ambiguities ambiguities;
  AttitudeRandomWalk random_walk;  // of its process; nothing that is estimated

  // Place in the error state.
  int first_ambiguity() const { return ekf_index::kSize + static_cast<int>(vehicle.size()); }
};

// Corrects `state` by an error in the order of ekf_index; the attitude only if `has_attitude`.
void add(const EkfCorrection& error, bool has_attitude, FilterState* state);

// The error of `reference` if `state` were true: add(difference(a, b), true, &b) makes b equal a.
// Both have the same vehicle's constants and the same ambiguities in the same order.
EkfCorrection difference(const FilterState& state, const FilterState& reference);

bool is_finite(const FilterState& state);

}  // namespace leonav
