// This unit searches for the rows of a range change that have slipped. Fits through few rows, drawn
// many times, show which of the rows agree with each other.
#pragma once
#include "core/gnss/cycle_slips/internal/range_change_fit.h"

namespace leonav {

// Result of the search.
struct SlipSearch {
  ChangeSet kept;       // rows that have not slipped, as far as the rows determine it
  ChangeSet doubtful;   // slipped in some explanations and not in others that are as good
  double scale = 1.0;   // of the sigmas, raised to the scatter of the kept rows
  bool decided = true;  // false: too many have slipped to decide which
};

// `subset` is the number of unknowns that few rows must determine: at least 1 and fewer than the
// rows.
SlipSearch search_slips(const ChangeFitter& fitter, std::size_t subset,
                        const CycleSlipConfig& config);

}  // namespace leonav
