// A text names the convention that an input breaks, and the remedy.
#pragma once
#include <string>

#include "core/installation_checks/convention.h"

namespace leonav {

// One line: the measured value, the likely mistake, the remedy. `value`: that of the event.
std::string convention_text(Convention convention, double value);

}  // namespace leonav
