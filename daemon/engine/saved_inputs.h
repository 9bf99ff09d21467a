// These functions give an engine what an earlier run has saved, before any other input.
#pragma once
#include <string>

#include "daemon/checkpoint/product_store.h"
#include "daemon/engine/engine.h"

namespace leonav {

// As inputs that came now: so they are in the journal, and a replay needs no file.
void receive_saved(const BroadcastProducts& products, Engine* engine);
void receive_saved(const Checkpoint& checkpoint, Engine* engine);

// Reads the checkpoint's file and the products beside it and passes them on; logs what was found. A
// file that is damaged is ignored, and so are both files where their disk does not answer within
// kLongestSavedReading_s: nothing of them is used later. Empty path: there is none. `before_read`,
// for tests, lets the disk wait.
void begin_from_saved(const std::string& checkpoint_path, Engine* engine,
                      const CheckpointHook& before_read = {});
inline constexpr double kLongestSavedReading_s = 1.0;

}  // namespace leonav
