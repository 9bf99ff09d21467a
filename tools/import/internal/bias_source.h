// This unit collects the biases of satellites' signals that come with the precise products of a
// recording.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "core/gnss/propagation/signal_bias_store.h"
#include "tools/import/bias_files.h"
#include "tools/import/import_report.h"

namespace leonav {

// A message of biases with its arrival; it holds kMaxBiases at most.
struct ScheduledBiases {
  GpsTime arrival;
  std::vector<SignalBias> biases;
};

// Reads Bias-SINEX files and schedules their biases for a recording from `start` to `end` (unset:
// not known): those that hold at `start` arrive then, the others kBiasLead_s before they begin to
// hold. Those whose validity lies outside are left out. `report` gets what the files leave out.
// Throws FileError for a file that cannot be read.
std::vector<ScheduledBiases> load_biases(const std::vector<std::string>& paths, GpsTime start,
                                         GpsTime end, ImportReport* report);

// Returns the messages of biases that arrive together.
std::vector<ScheduledBiases> in_messages(
    const std::map<GpsTime, std::vector<SignalBias>>& by_arrival);

}  // namespace leonav
