// This unit lists the signals that a receiver tracks of each system, in the order of its records.
#pragma once
#include <span>

#include "core/gnss/signals/satellite.h"
#include "core/gnss/signals/signal.h"

namespace leonav::sim {

std::span<const SignalCode> signals_of(System system);

}  // namespace leonav::sim
