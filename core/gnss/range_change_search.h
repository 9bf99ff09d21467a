// Which rows of a range change have slipped: fits through few rows, drawn many times, show which of
// them agree with one another.
#pragma once
#include "core/gnss/range_change_fit.h"

namespace leonav {

struct SlipSearch {
  ChangeSet kept;       // not slipped, as far as can be told
  ChangeSet doubtful;   // slipped in some explanations and not in others that are as good
  double scale = 1.0;   // of the sigmas, widened to how the kept rows scatter
  bool decided = true;  // false: too many have slipped to tell which
};

// `subset`: unknowns that few rows must determine, at least 1 and fewer than the rows.
SlipSearch search_slips(const ChangeFitter& fitter, std::size_t subset,
                        const CycleSlipConfig& config);

}  // namespace leonav
