#include "tools/quality/code_steps.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace leonav {
namespace {

constexpr double kMinStep_m = 8.0;  // above what the noise of a phone's codes does to a median
constexpr double kMaxStep_m = 1000.0;
constexpr double kTolerance_m = 8.0;
constexpr std::size_t kMinSignals = 5;

// 0: no step that the signals share.
double common_step_m(std::vector<double> changes_m) {
  if (changes_m.size() < kMinSignals) return 0.0;
  const auto middle = changes_m.begin() + static_cast<std::ptrdiff_t>(changes_m.size() / 2);
  std::nth_element(changes_m.begin(), middle, changes_m.end());
  const double step_m = *middle;
  const auto near = std::count_if(changes_m.begin(), changes_m.end(), [&](double change_m) {
    return std::abs(change_m - step_m) <= kTolerance_m;
  });
  const bool shared = 2 * static_cast<std::size_t>(near) > changes_m.size();
  return shared && std::abs(step_m) >= kMinStep_m && std::abs(step_m) <= kMaxStep_m ? step_m : 0.0;
}

}  // namespace

void CodeSteps::repair(RawEpoch* epoch) {
  ++epoch_;
  std::vector<double> changes_m;
  for (const SignalObservation& o : epoch->observations) {
    const double wavelength = wavelength_m(o.satellite.system, o.code.band);
    const double now_m = o.pseudorange_m - o.carrier_cycles * wavelength;
    if (!(wavelength > 0.0) || !std::isfinite(now_m)) continue;
    Before& before = before_[{o.satellite, o.code}];
    if (before.epoch + 1 == epoch_ && before.epoch != 0)
      changes_m.push_back(now_m - before.code_minus_carrier_m);
    before = {epoch_, now_m};
  }
  const double step_m = common_step_m(std::move(changes_m));
  if (step_m != 0.0) ++count_;
  offset_m_ += step_m;
  for (SignalObservation& o : epoch->observations) o.pseudorange_m -= offset_m_;
}

}  // namespace leonav
