// A text for the daemon's log states what use was made of the checkpoint.
#pragma once
#include <string>

#include "core/navigator/interface/checkpoint.h"

namespace leonav {

// `value`: that of the event.
std::string checkpoint_text(CheckpointUse use, double value);

}  // namespace leonav
