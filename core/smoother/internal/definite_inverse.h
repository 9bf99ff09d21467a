// This unit inverts a covariance matrix of states with very different units.
#pragma once
#include "core/filter/state/ekf_state.h"

namespace leonav {

// Inverts a positive definite matrix whose diagonal may span many orders of magnitude. Returns
// false if it is not positive definite.
bool invert(const EkfCovariance& matrix, EkfCovariance* inverse);

}  // namespace leonav
