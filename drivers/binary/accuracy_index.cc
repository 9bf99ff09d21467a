#include "drivers/binary/accuracy_index.h"

#include <array>
#include <cmath>

namespace leonav {

double nominal_accuracy_m(unsigned index) {
  constexpr std::array<double, 7> kFine = {2.0, 2.8, 4.0, 5.7, 8.0, 11.3, 16.0};
  if (index < kFine.size()) return kFine[index];
  return index < 15 ? std::ldexp(1.0, static_cast<int>(index) - 2) : -1.0;
}

double galileo_sisa_m(unsigned index) {
  if (index < 50) return 0.01 * index;
  if (index < 75) return 0.5 + 0.02 * (index - 50);
  if (index < 100) return 1.0 + 0.04 * (index - 75);
  if (index < 126) return 2.0 + 0.16 * (index - 100);
  return -1.0;
}

}  // namespace leonav
