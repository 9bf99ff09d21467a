// Equality of two configurations, field by field, wherever they come from.
#pragma once
#include "daemon/config/daemon_config.h"

namespace leonav::test {

inline bool same_config(const DaemonConfig& a, const DaemonConfig& b) {
  // Names every field, so that a new one must be added here; `source` is where they come from.
  const auto& [navigator, lcm, commands, journal, checkpoint, threads, drill, log, source] = a;
  return navigator == b.navigator && lcm == b.lcm && commands == b.commands &&
         journal == b.journal && checkpoint == b.checkpoint && threads == b.threads &&
         drill == b.drill && log == b.log;
}

}  // namespace leonav::test
