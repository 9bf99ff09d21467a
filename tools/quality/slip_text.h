// Slips and interruptions in words: shared by table, JSON and CSV.
#pragma once
#include <array>
#include <string>

#include "tools/quality/quality.h"

namespace leonav {

struct SlipTotals {
  std::uint64_t followed = 0, slips = 0, told_slips = 0, interruptions = 0, unresolved = 0;
  // TEQC's o/slps: satellite-epochs with a followed carrier per slip; NaN without a slip.
  double observations_per_slip() const;
};
std::array<SlipTotals, kSystemCount> slip_totals(const Quality& quality);

std::string signals_text(const ArcBreak& one);  // "1C+2W"
std::string causes_text(SlipCauses causes);     // "geometry_free+loss_of_lock"

// Totals per system and cause, and the first `shown` slips.
std::string slips_table(const Quality& quality, std::size_t shown);

}  // namespace leonav
