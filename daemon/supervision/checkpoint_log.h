// The CheckpointLog logs, each once, what became of the checkpoint that was read, and why the next
// one cannot be written.
#pragma once
#include <cstdint>
#include <string>

#include "daemon/engine/engine.h"
#include "daemon/supervision/changed.h"

namespace leonav {

class CheckpointLog {
 public:
  explicit CheckpointLog(Engine* engine) : engine_(engine) {}

  // Once a second.
  void look();

 private:
  Engine* engine_;
  Changed<std::int64_t> use_, calibration_use_;  // 0: there was none yet
  Changed<std::string> error_;
};

}  // namespace leonav
