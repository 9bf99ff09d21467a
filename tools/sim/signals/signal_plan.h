// Which signals a receiver tracks of each system, in the order of its observation records.
#pragma once
#include <span>

#include "core/gnss/satellite.h"
#include "core/gnss/signal.h"

namespace leonav::sim {

std::span<const SignalCode> signals_of(System system);

}  // namespace leonav::sim
