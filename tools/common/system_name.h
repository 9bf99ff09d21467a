// This function names a satellite system in sentences for users.
#pragma once
#include "core/gnss/signals/satellite.h"

namespace leonav {

// Returns "GPS", "Galileo", "BeiDou" or "LEO".
const char* name_of(System system);

}  // namespace leonav
