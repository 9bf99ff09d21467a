// This unit finds what a user must not overlook in a run that ended without an error.
#pragma once
#include <string>
#include <vector>

#include "core/navigator/sequencer/sequencer.h"
#include "daemon/messages/input_dispatch.h"
#include "tools/replay/run_statistics.h"

namespace leonav {

// Returns the warnings, one line each.
//
// There is one for every stream of which more than half of the messages were not used, and one if
// more than half of the epochs gave no position, with the reasons and their counts, most frequent
// first. One follows for each input that violates a convention, with the remedy, and one if the run
// ends while aligning, with what the alignment lacks.
std::vector<std::string> run_warnings(const InputDispatch::Counters& received,
                                      const Sequencer::Counters& accepted,
                                      const RunStatistics& statistics,
                                      const AlignmentConfig& alignment);

}  // namespace leonav
