// This unit collects the antenna models of a recording.
#pragma once
#include <string>
#include <vector>

#include "core/gnss/propagation/antenna_model.h"
#include "tools/import/dataset.h"
#include "tools/import/import_report.h"

namespace leonav {

// Returns the patterns of the receiver antenna, then of every satellite that has a model valid at
// `time`.
//
// Of several files the first that contains an antenna counts. `header_antenna` is the name in the
// observation file's header; the dataset's `receiver_antenna` has precedence. `report` gets what is
// left out, and a warning for what is missing with its consequence. Throws FileError for a file
// that cannot be read.
std::vector<AntennaPattern> load_antennas(const Dataset& dataset, const std::string& header_antenna,
                                          GpsTime time, ImportReport* report);

}  // namespace leonav
