// What a user must not overlook in a run that ended well.
#pragma once
#include <string>
#include <vector>

#include "core/navigator/sequencer.h"
#include "daemon/input_dispatch.h"
#include "run_statistics.h"

namespace leonav {

// One line each where more than half of a stream's messages were not used, or more than half of the
// epochs gave no position; with the reasons and their counts, most frequent first. Then one for
// each input that does not follow a convention, with the remedy, and one where the run ends while
// aligning, with what that lacks.
std::vector<std::string> run_warnings(const InputDispatch::Counters& received,
                                      const Sequencer::Counters& accepted,
                                      const RunStatistics& statistics,
                                      const AlignmentConfig& alignment);

}  // namespace leonav
