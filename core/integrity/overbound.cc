#include "core/integrity/overbound.h"

#include <cmath>
#include <numbers>

namespace leonav {
namespace {

// Returns 2 Q(distance / sigma). Precondition: distance > 0; a sigma of 0 gives 0.
double both_tails(double distance, double sigma) {
  return std::erfc(distance / (sigma * std::numbers::sqrt2));
}

}  // namespace

double exceedance(double distance, double sigma, const Overbound& overbound) {
  if (distance <= 0.0) return 1.0;
  const double core = overbound.sigma_factor * sigma;
  const double tail = overbound.tail_factor * core;
  return (1.0 - overbound.tail_share) * both_tails(distance, core) +
         overbound.tail_share * both_tails(distance, tail);
}

}  // namespace leonav
