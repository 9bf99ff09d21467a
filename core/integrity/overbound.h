// This function gives the probability of an error beyond a distance under a heavy-tailed overbound.
#pragma once
#include "core/integrity/integrity_config.h"

namespace leonav {

// Returns the probability that the absolute value of an error exceeds `distance`, for the
// distribution that `overbound` makes of 1 sigma `sigma`:
//   2 (1 - tail_share) Q(distance / core) + 2 tail_share Q(distance / tail)
// Q is the upper tail of the standard normal distribution. 1 for a distance that is not positive:
// an overbound says nothing about errors that small. Both arguments share one unit.
double exceedance(double distance, double sigma, const Overbound& overbound);

}  // namespace leonav
