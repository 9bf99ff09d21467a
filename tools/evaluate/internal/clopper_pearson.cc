#include "tools/evaluate/internal/clopper_pearson.h"

#include <boost/math/special_functions/beta.hpp>

namespace leonav {

double upper_bound_of_share(std::size_t events, std::size_t trials, double confidence) {
  if (events >= trials) return 1.0;
  // The binomial distribution's tail is an incomplete beta function.
  return boost::math::ibeta_inv(static_cast<double>(events) + 1.0,
                                static_cast<double>(trials - events), confidence);
}

}  // namespace leonav
