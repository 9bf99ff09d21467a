// The counts of received, rejected and accepted inputs are copied to the engine's counters.
#pragma once
#include "core/navigator/sequencer/sequencer.h"
#include "daemon/messages/input_dispatch.h"
#include "daemon/threads/counters.h"

namespace leonav {

// Thread `io`, to which `dispatch` and `sequencer` belong.
void copy_input_counters(const InputDispatch& dispatch, const Sequencer& sequencer,
                         EngineCounters* counters);

}  // namespace leonav
