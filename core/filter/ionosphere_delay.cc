#include "core/filter/ionosphere_delay.h"

#include <cmath>

#include "core/base/square.h"

namespace leonav {

void update_ionosphere(const MeasurementEpoch& epoch, StateEstimate* estimate) {
  estimate->step_ionosphere_model(epoch.ionosphere_step_m);
  double sum = 0.0;
  int count = 0;
  for (const Measurement& code : epoch.measurements) {
    if (!(code.ionosphere.zenith_sigma > 0.0)) continue;
    sum += square(code.ionosphere.zenith_sigma);
    ++count;
  }
  if (count > 0) estimate->set_ionosphere_sigma(std::sqrt(sum / count));
}

}  // namespace leonav
