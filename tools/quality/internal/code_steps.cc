#include "tools/quality/internal/code_steps.h"

#include <cmath>
#include <vector>

#include "core/robust/common_step.h"

namespace leonav {
namespace {

constexpr double kMaxStep_m = 1000.0;
// 1 sigma of the change of code minus carrier between two epochs; a phone's code has 2 m.
constexpr double kChangeSigma_m = 3.0;

}  // namespace

void CodeSteps::repair(RawEpoch* epoch) {
  ++epoch_;
  std::vector<StepSample> changes;  // one per satellite, because its signals are not independent
  SatelliteId last;
  for (const SignalObservation& o : epoch->observations) {
    const double wavelength = bands_.wavelength_m(o.satellite.system, o.code.band);
    const double now_m = o.pseudorange_m - o.carrier_cycles * wavelength;
    if (!(wavelength > 0.0) || !std::isfinite(now_m)) continue;
    Before& before = before_[{o.satellite, o.code}];
    const bool other = changes.empty() || o.satellite != last;
    if (before.epoch + 1 == epoch_ && before.epoch != 0 && other) {
      changes.push_back({now_m - before.code_minus_carrier_m, kChangeSigma_m});
      last = o.satellite;
    }
    before = {epoch_, now_m};
  }
  const auto step = find_common_step(changes, 0.0);
  if (step && std::abs(step->value_m) <= kMaxStep_m) {
    ++count_;
    offset_m_ += step->value_m;
  }
  for (SignalObservation& o : epoch->observations) o.pseudorange_m -= offset_m_;
}

}  // namespace leonav
