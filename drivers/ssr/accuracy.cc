#include "drivers/ssr/accuracy.h"

#include <cmath>

namespace leonav {

std::optional<double> ssr_accuracy_m(std::uint8_t index) {
  if (index == 0 || index >= kWorstSsrAccuracy) return std::nullopt;
  const int of_class = index >> 3, value = index & 7;
  return (std::pow(3.0, of_class) * (1.0 + value / 4.0) - 1.0) * 1e-3;
}

}  // namespace leonav
