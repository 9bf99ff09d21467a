#include "core/robust/igg3.h"

#include <cmath>

namespace leonav {

// Y. Yang, L. Song and T. Xu, Robust estimator for correlated observations based on bifactor
// equivalent weights, Journal of Geodesy 76, 2002: the weight is multiplied by
//   1                                          for |v| <= k0,
//   (k0 / |v|) ((k1 - |v|) / (k1 - k0))^2      for k0 < |v| < k1,
//   0                                          from k1 on.
// Electronics 2024 eq. 32 is the same factor, but its eq. 33 multiplies the variance by it, which
// would trust outliers most. Here the variance is divided by it, as in the original.
double igg3_factor(double standardized_residual, double k0, double k1) {
  const double v = std::abs(standardized_residual);
  if (v <= k0) return 1.0;
  if (!(v < k1)) return 0.0;  // NaN is excluded too
  const double fall = (k1 - v) / (k1 - k0);
  return k0 / v * fall * fall;
}

}  // namespace leonav
