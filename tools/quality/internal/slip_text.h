// This unit turns slips and interruptions into text for table, JSON and CSV.
#pragma once
#include <array>
#include <string>

#include "tools/quality/quality.h"

namespace leonav {

// Counts of one system.
struct SlipTotals {
  std::uint64_t followed = 0, slips = 0, flagged_slips = 0, interruptions = 0, unresolved = 0;
  // Returns TEQC's o/slps: satellite-epochs with a tracked carrier per slip; NaN without a slip.
  double observations_per_slip() const;
};
// Sums up the counts per system.
std::array<SlipTotals, kSystemCount> slip_totals(const Quality& quality);

std::string signals_text(const ArcBreak& one);  // "1C+2W"
std::string causes_text(SlipCauses causes);     // "geometry_free+loss_of_lock"

// Returns totals per system and cause, and the first `shown` slips.
std::string slips_table(const Quality& quality, std::size_t shown);

}  // namespace leonav
