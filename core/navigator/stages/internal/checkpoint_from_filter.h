// checkpoint_from_filter() writes what one run leaves for the next from the filter at an epoch.
#pragma once
#include "core/filter/ekf.h"
#include "core/inertial/alignment/alignment.h"
#include "core/navigator/interface/checkpoint.h"
#include "core/navigator/interface/solution.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

// `solution`: that of `filter`, which is initialized. The vehicle stands where the filter's
// velocity is that of standing, and certain, and the mean rate of the block's gyros is still.
// Without attitude the heading's sigma is pi.
Checkpoint checkpoint_from_filter(const EpochWork& work, const Ekf& filter,
                                  const Solution& solution, const AlignmentConfig& config);

}  // namespace leonav
