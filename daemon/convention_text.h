// What a mistaken convention is called, and what to do about it.
#pragma once
#include <string>

#include "core/conventions/convention.h"

namespace leonav {

// One line: what was measured, what that looks like, the remedy. `value`: the event's.
std::string convention_text(Convention convention, double value);

}  // namespace leonav
