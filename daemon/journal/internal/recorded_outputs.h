// This function translates a key of the configuration into what a journal says about itself.
#pragma once
#include "daemon/config/daemon_config.h"
#include "drivers/lcm/journal_marks.h"

namespace leonav {

inline RecordedOutputs recorded_outputs(JournalOutputs outputs) {
  switch (outputs) {
    case JournalOutputs::kThinned:
      return RecordedOutputs::kThinned;
    case JournalOutputs::kNone:
      return RecordedOutputs::kNone;
    default:
      return RecordedOutputs::kAll;
  }
}

}  // namespace leonav
