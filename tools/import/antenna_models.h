// This unit reads the antenna models of ANTEX files, for a recording and for a live service.
#pragma once
#include <string>
#include <vector>

#include "core/gnss/propagation/antenna_model.h"
#include "drivers/antex/antex_reader.h"
#include "tools/import/import_report.h"

namespace leonav {

struct AntennaModels {
  std::vector<AntennaPattern>
      receiver;  // one of each band; empty: no model of the antenna asked for
  std::vector<AntennaPattern> satellites;  // one of each band and validity
};

// Reads the models of all satellites that are valid at `time` (unset: at any time), and that of the
// receiver antenna `name` (antenna_name(); empty: none).
//
// Of several files the first that contains an antenna counts. `report` gets what is left out, the
// receiver antenna that is used, and a warning where its model is missing or has no radome. Throws
// FileError for a file that cannot be read.
AntennaModels read_antenna_models(const std::vector<std::string>& paths, const std::string& name,
                                  GpsTime time, ImportReport* report);

// What a receiver antenna without a model costs.
extern const char* const kWithoutReceiverAntenna;

}  // namespace leonav
