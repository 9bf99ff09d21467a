// This function tells where the error of one satellite moves the filter's state.
#pragma once
#include "core/filter/update/filter_measurement.h"

namespace leonav {

// Returns the change of the state by an error of one metre in the carrier at `faulty`, an index of
// `measurements`. Position and clocks change as in a least-squares fit to all carriers,
//   x = (sum h h^T / s^2)^-1 h_k / s_k^2
// and every ambiguity by -h x, so that no carrier shows the change: only codes do. `size` is that
// of the state.
EkfCorrection fault_direction(const FilterMeasurements& measurements, std::size_t faulty,
                              Eigen::Index size);

}  // namespace leonav
