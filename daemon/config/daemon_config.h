// DaemonConfig holds the whole configuration of the daemon.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/navigator/interface/navigator_config.h"
#include "daemon/config/config_key.h"

namespace leonav {

// Delays on purpose, to drill missed deadlines; in the service only.
struct DrillConfig {
  int late_solve_every = 0;  // epochs; 0: never
  double late_solve_s = 0.8;

  bool operator==(const DrillConfig&) const = default;
};

struct LcmConfig {
  // ttl=0: messages stay on this host.
  std::string url = "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=4194304";
  std::string prefix = "LEONAV_";
  int receive_queue = 4096;  // messages per channel that liblcm keeps at most while `io` is busy

  bool operator==(const LcmConfig&) const = default;
};

// Outputs that the journal holds. All of them follow from the inputs and decisions.
enum class JournalOutputs : std::uint8_t {
  kAll,
  kThinned,  // one SOLUTION a second, and all others
  kNone,     // none of SOLUTION, EPOCH, CONSTRAINTS, SMOOTHED
};

// Who may send commands.
struct CommandsConfig {
  std::string key_file;  // empty: whoever can send to the channels

  bool operator==(const CommandsConfig&) const = default;
};

struct JournalConfig {
  std::string path;  // empty: no journal
  JournalOutputs outputs = JournalOutputs::kAll;
  double flush_interval_s = 1.0;
  double buffer_mb = 8.0;     // memory in which messages wait for the disk
  double piece_mb = 256.0;    // a larger piece is ended
  double piece_s = 3600.0;    // an older piece is ended; 0: of any age
  double total_mb = 10000.0;  // all pieces but those that are kept; 0: no limit
  double kept_mb = 2000.0;    // pieces around faults; 0: none is kept

  bool operator==(const JournalConfig&) const = default;
};

struct CheckpointConfig {
  std::string path;  // empty: none is read or written
  double interval_s = 10.0;

  bool operator==(const CheckpointConfig&) const = default;
};

// What the daemon's log tells.
enum class LogLevel : std::uint8_t { kInfo, kWarning, kError };

struct LogConfig {
  LogLevel level = LogLevel::kInfo;

  bool operator==(const LogConfig&) const = default;
};

struct ThreadConfig {
  int priority = 0;  // SCHED_FIFO priority 1-99; 0: the ordinary scheduler
  int cpu = -1;      // pinned to this processor; -1: any

  bool operator==(const ThreadConfig&) const = default;
};

struct ThreadsConfig {
  bool lock_memory = true;  // mlockall
  ThreadConfig io, ins, gnss, smoother, out;

  bool operator==(const ThreadsConfig&) const = default;
};

// Origin of the configuration, with every key.
struct ConfigOrigin {
  std::string name;             // the file, or "preset NAME"
  std::vector<ConfigKey> keys;  // every key, in the order of the reference; empty: not from a file

  // How an error about a key begins: "FILE:LINE: KEY" or "--set KEY"; "KEY": its default holds.
  std::string place_of(std::string_view key) const;
};

struct DaemonConfig {
  NavigatorConfig navigator;
  LcmConfig lcm;
  CommandsConfig commands;
  JournalConfig journal;
  CheckpointConfig checkpoint;
  ThreadsConfig threads;
  DrillConfig drill;
  LogConfig log;
  ConfigOrigin source;
};

}  // namespace leonav
