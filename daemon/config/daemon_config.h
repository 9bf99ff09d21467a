// Everything the configuration file says.
#pragma once
#include <string>
#include <vector>

#include "core/navigator/navigator_config.h"

namespace leonav {

// Delays on purpose, in the service only.
struct DrillConfig {
  int late_solve_every = 0;  // epochs; 0: never
  double late_solve_s = 0.8;
};

struct LcmConfig {
  // ttl=0: messages stay on this host.
  std::string url = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";
  std::string prefix = "LEONAV_";
  int receive_queue = 4096;  // messages per channel that liblcm keeps while `io` is busy
};

struct JournalConfig {
  std::string path;  // empty: no journal
  double flush_interval_s = 1.0;
};

struct CheckpointConfig {
  std::string path;  // empty: none is read or written
  double interval_s = 10.0;
};

struct ThreadConfig {
  int priority = 0;  // SCHED_FIFO priority 1-99; 0: the ordinary scheduler
  int cpu = -1;      // pinned to this processor; -1: any
};

struct ThreadsConfig {
  bool lock_memory = true;  // mlockall
  ThreadConfig io, ins, gnss, smoother, out;
};

// Where the configuration came from, for the journal.
struct ConfigText {
  std::string name;  // the file
  std::string text;  // its content; empty: not from a file
  // group.key=value, of the command line and then of what the files said that the text names: text
  // and overrides give the same configuration where those files are not, or have changed.
  std::vector<std::string> overrides;
};

struct DaemonConfig {
  NavigatorConfig navigator;
  LcmConfig lcm;
  JournalConfig journal;
  CheckpointConfig checkpoint;
  ThreadsConfig threads;
  DrillConfig drill;
  ConfigText source;
};

}  // namespace leonav
