// What the two halves of a log say of what the whole has found.
#pragma once
#include "tools/calibration/calibration_run.h"

namespace leonav {

// What the halves tell apart is half of their difference away from their mean: where that is more
// than the filter believes, it has errors that the filter does not know. Returns what both halves
// have observed; of the others the sigma is the filter's alone.
std::array<bool, kQuantities> compare_halves(const Finding& first, const Finding& second,
                                             Finding* whole);

// What turns out not to be known after all stays as it was configured, and is no longer observed.
void withdraw_unknown(const InstallationPrior& prior, const Installation& configured,
                      Finding* finding, Installation* found);

}  // namespace leonav
