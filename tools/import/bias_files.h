// This unit reads the biases of satellites' signals in Bias-SINEX files, for a recording and for a
// live service.
#pragma once
#include <string>
#include <vector>

#include "core/gnss/propagation/signal_bias_store.h"
#include "tools/import/import_report.h"

namespace leonav {

// Reads a file; `time` of its biases is unset. `report` gets what the file leaves out. Throws
// FileError for a file that cannot be read.
std::vector<SignalBias> read_bias_file(const std::string& path, ImportReport* report);

// A bias is sent so long before it begins to hold: longer than an epoch is late, and short against
// the validity of a bias, because of each signal the store keeps two.
inline constexpr double kBiasLead_s = 60.0;

}  // namespace leonav
