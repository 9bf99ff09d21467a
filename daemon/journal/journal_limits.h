// JournalLimits are the settings of a journal that may change while it is written.
#pragma once
#include <cstdint>

#include "daemon/config/daemon_config.h"

namespace leonav {

// The fields of JournalConfig of the same names.
struct JournalLimits {
  double flush_interval_s = 0.0, piece_mb = 0.0, piece_s = 0.0, total_mb = 0.0, kept_mb = 0.0;
  JournalOutputs outputs = JournalOutputs::kAll;
};

inline JournalLimits limits_of(const JournalConfig& config) {
  return {config.flush_interval_s, config.piece_mb, config.piece_s,
          config.total_mb,         config.kept_mb,  config.outputs};
}

inline std::int64_t bytes_of_megabytes(double megabytes) {
  return static_cast<std::int64_t>(megabytes * 1e6);
}

}  // namespace leonav
