// The antenna models of a recording.
#pragma once
#include <string>
#include <vector>

#include "core/gnss/antenna_model.h"
#include "tools/dataset/dataset.h"
#include "tools/dataset/import_report.h"

namespace leonav {

// The patterns of the receiver antenna, then of every satellite that has a model valid at `time`;
// of several files the first that has an antenna counts. `header_antenna` is the name in the
// observation file's header; the dataset's `receiver_antenna` goes before it. `report` gets what is
// left out, and a warning for what is missing and what will be worse for it. Throws FileError for a
// file that cannot be read.
std::vector<AntennaPattern> load_antennas(const Dataset& dataset, const std::string& header_antenna,
                                          GpsTime time, ImportReport* report);

}  // namespace leonav
