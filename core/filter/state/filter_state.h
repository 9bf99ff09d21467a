// CoreState and FilterState are nominal states; add() and difference() connect them with the error
// state.
#pragma once
#include "core/filter/state/ekf_state.h"
#include "core/inertial/strapdown/nav_state.h"

namespace leonav {

// Additional noise of the attitude for a limited time. An attitude found by alignment is wrong in
// ways that its variances do not contain.
struct AttitudeRandomWalk {
  double noise = 0.0;  // rad/sqrt(s)
  GpsTime until;
};

// CoreState holds the states of one instant that are not of a single carrier arc.
struct CoreState {
  NavState nav;
  ClockState clocks;
  double wet_delay_m = 0.0;      // at zenith, beyond the modelled one
  double carrier_clock_m = 0.0;  // clock of the carriers minus that of the codes
  double ionosphere_m = 0.0;     // of L1 at zenith, beyond the modelled one
  VehicleConstants vehicle;
  AttitudeRandomWalk random_walk;  // part of the process model; not estimated

  // Number of errors, in the order of ekf_index.
  int size() const { return ekf_index::kSize + static_cast<int>(vehicle.size()); }
};

// FilterState is the filter's whole nominal state.
struct FilterState : CoreState {
  Ambiguities ambiguities;

  // Index of the first ambiguity in the error state.
  int first_ambiguity() const { return size(); }
};

// These add an error in the order of ekf_index to `state`; to the attitude only if `has_attitude`.
// Of a longer error the first entries are those of a core state.
void add(const EkfCorrection& error, bool has_attitude, CoreState* state);
void add(const EkfCorrection& error, bool has_attitude, FilterState* state);

// These return the error of `reference` if `state` were true: add(difference(a, b), true, &b) makes
// b equal to a. Both must have the same vehicle constants and the same ambiguities in the same
// order.
EkfCorrection difference(const CoreState& state, const CoreState& reference);
EkfCorrection difference(const FilterState& state, const FilterState& reference);

// These return false once any number is infinite or not a number.
bool is_finite(const CoreState& state);
bool is_finite(const FilterState& state);

}  // namespace leonav
