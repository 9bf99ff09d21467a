// What became of the checkpoint, in words for the daemon's log.
#pragma once
#include <string>

#include "core/navigator/checkpoint.h"

namespace leonav {

// `value` as the event has it.
std::string checkpoint_text(CheckpointUse use, double value);

}  // namespace leonav
