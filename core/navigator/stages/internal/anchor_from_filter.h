// This function makes the anchor of an epoch from the filter's state after it.
#pragma once
#include <cstdint>

#include "core/filter/ekf.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

// Returns the anchor of epoch `index`, which is not valid while the filter is not initialized.
Anchor anchor_from_filter(std::uint64_t index, const Ekf& filter, bool gnss_used,
                          const LevelGrowth& levels);

}  // namespace leonav
