#include "tools/calibrate/data_halves.h"

#include <algorithm>
#include <cmath>

namespace leonav {
namespace {

double prior_of(Quantity quantity, const InstallationPrior& prior) {
  if (quantity <= Quantity::kArmDown) return prior.lever_arm_m;
  return quantity == Quantity::kTimeOffset ? prior.time_offset_s : prior.travel_rad;
}

}  // namespace

std::array<bool, kQuantities> compare_halves(const Finding& first, const Finding& second,
                                             Finding* whole) {
  std::array<bool, kQuantities> compared{};
  for (std::size_t i = 0; i < kQuantities; ++i) {
    compared[i] = first.observed[i] && second.observed[i];
    const double apart = 0.5 * std::abs(first.change[i] - second.change[i]);
    if (compared[i]) whole->sigma[i] = std::max(whole->sigma[i], apart);
  }
  return compared;
}

void revert_unobserved(const InstallationPrior& prior, const Installation& configured,
                       Finding* finding, Installation* found) {
  for (std::size_t i = 0; i < kQuantities; ++i)
    finding->observed[i] =
        finding->observed[i] &&
        finding->sigma[i] < prior.observed_share * prior_of(static_cast<Quantity>(i), prior);
  const auto known = [&](Quantity quantity) {
    return finding->observed[static_cast<std::size_t>(quantity)];
  };
  // The axes come first, because the lever arm is given in them.
  *found = turned_by_known(
      configured, *found, {known(Quantity::kRoll), known(Quantity::kPitch), known(Quantity::kYaw)});
  for (int axis = 0; axis < 3; ++axis)
    if (!known(static_cast<Quantity>(axis)))
      found->lever_arm_b(axis) = configured.lever_arm_b(axis);
  if (!known(Quantity::kTimeOffset)) found->time_offset_s = configured.time_offset_s;
}

}  // namespace leonav
