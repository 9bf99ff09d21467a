// anchor_from_filter() writes what the inertial stage goes on from: the filter's state at an epoch.
#pragma once
#include <cstdint>

#include "core/filter/ekf.h"
#include "core/navigator/interface/stage_work.h"

namespace leonav {

// Of epoch `index`; not valid while the filter is not initialized.
Anchor anchor_from_filter(std::uint64_t index, const Ekf& filter, bool gnss_used);

}  // namespace leonav
