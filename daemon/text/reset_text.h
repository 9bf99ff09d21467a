// This function says why the filter has started over.
#pragma once
#include <string_view>

#include "core/navigator/interface/event.h"

namespace leonav {

// For instance "the heading contradicts the motion".
std::string_view reset_text(ResetCause cause);

}  // namespace leonav
