#include "core/navigator/stages/internal/anchor_from_filter.h"

#include "core/filter/state/covariance_blocks.h"

namespace leonav {

Anchor anchor_from_filter(std::uint64_t index, const Ekf& filter, bool gnss_used,
                          const LevelGrowth& levels) {
  Anchor anchor;
  anchor.index = index;
  anchor.valid = filter.initialized();
  if (!anchor.valid) return anchor;
  anchor.has_attitude = filter.has_attitude();
  anchor.state = filter.state();
  anchor.covariance = inertial_covariance(filter.covariance());
  anchor.gnss_used = gnss_used;
  anchor.random_walk = filter.filter_state().random_walk;
  anchor.levels = levels;
  anchor.time_offset_s =
      filter.has_attitude() ? time_offset_of(filter.filter_state().vehicle) : 0.0;
  return anchor;
}

}  // namespace leonav
