// The CheckpointLog logs, each once, what became of the checkpoint that was read, and why the next
// one cannot be written.
#pragma once
#include <cstdint>
#include <string>

#include "daemon/engine/engine.h"

namespace leonav {

class CheckpointLog {
 public:
  explicit CheckpointLog(Engine* engine) : engine_(engine) {}

  // Once a second.
  void look();

 private:
  Engine* engine_;
  std::int64_t last_use_ = 0, last_calibration_use_ = 0;
  std::string last_error_;
};

}  // namespace leonav
