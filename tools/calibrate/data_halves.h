// This unit compares the findings from the two halves of a log with that from the whole log.
#pragma once
#include "tools/calibrate/calibration_run.h"

namespace leonav {

// Raises the sigmas of `whole` to half of the difference between the halves where that is larger.
//
// A larger difference shows errors that are not modelled. Returns which quantities both
// halves have observed; the sigma of the others is the whole log's alone.
std::array<bool, kQuantities> compare_halves(const Finding& first, const Finding& second,
                                             Finding* whole);

// Returns quantities that are not observed after all to their configured values.
void revert_unobserved(const InstallationPrior& prior, const Installation& configured,
                       Finding* finding, Installation* found);

}  // namespace leonav
