// Inverse of a covariance.
#pragma once
#include "core/ekf/ekf_state.h"

namespace leonav {

// Of a positive definite matrix whose diagonal may span many orders of magnitude; false: it is
// none.
bool invert(const EkfCovariance& matrix, EkfCovariance* inverse);

}  // namespace leonav
