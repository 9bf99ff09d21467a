// This unit reads the tables of broadcast elements of LEO satellites, for a recording and for a
// live service.
#pragma once
#include <string>
#include <vector>

#include "core/gnss/orbits/ephemeris.h"
#include "tools/import/import_report.h"

namespace leonav {

// Reads a table. `report` gets its unusable rows. Throws FileError for a file that cannot be read.
std::vector<Ephemeris> read_leo_element_file(const std::string& path, ImportReport* report);

}  // namespace leonav
