// This function makes the checkpoint for the next run from the filter at an epoch.
#pragma once
#include "core/filter/ekf.h"
#include "core/navigator/interface/checkpoint.h"
#include "core/navigator/interface/navigator_config.h"
#include "core/navigator/interface/solution.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

// Returns the checkpoint; `solution` is that of `filter`. Precondition: `filter` is initialized.
// The vehicle counts as standing if the velocity agrees with zero, its sigma is below 0.1 m/s, and
// the mean rate of the gyros over the block is below AlignmentConfig::static_gyro_rad_s. Without
// attitude the heading's sigma is pi, and there is no calibration.
Checkpoint checkpoint_from_filter(const EpochWork& work, const Ekf& filter,
                                  const Solution& solution, const NavigatorConfig& config);

}  // namespace leonav
