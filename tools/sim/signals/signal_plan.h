// This unit lists the signals that a receiver tracks of each system, in the order of its records.
#pragma once
#include <span>

#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"
#include "tools/sim/scenario/scenario.h"

namespace leonav::sim {

// Returns the two signals of the system; the span is valid as long as the scenario.
std::span<const SignalCode> signals_of(const Scenario& scenario, System system);

}  // namespace leonav::sim
