// This function makes the delays by which missed deadlines are drilled.
#pragma once
#include "daemon/engine/engine.h"

namespace leonav {

// Empty hooks where the configuration asks for no delay.
EngineHooks drill_hooks(const DrillConfig& drill);

}  // namespace leonav
