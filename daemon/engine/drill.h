// This function makes the delays by which missed deadlines are drilled.
#pragma once
#include "daemon/engine/engine.h"

namespace leonav {

// Empty hooks where the configuration asks for no delay, or has no smoother. Says which drills are
// on, those without a delay too.
EngineHooks drill_hooks(const DaemonConfig& config);

}  // namespace leonav
