// This unit maps the observation type names of a RINEX header to signals.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "drivers/rinex/observation_header.h"

namespace leonav {

// Maps a RINEX 3 name, e.g. "C1C". kind is 0 for types that leonav does not use (channel numbers,
// ionosphere delays, names without attribute).
ObservationType observation_type_3(char system, std::string_view name, int version_hundredths);

// Maps the RINEX 2 names of a whole file, e.g. "C1", "P2", for one system. RINEX 2 does not define
// which code a carrier, Doppler or strength belongs to; here they belong to
//   GPS, LEO L1: C/A (1C) if C1 is in the file, else P (1W); L2: P (2W) if P2 is, else L2C (2X);
//     where that code was not measured and the other was, with the other (`fallback`);
//   L5: 5X; Galileo: 1X, 5X, 6X, 7X, 8X; BeiDou: 2I, 6I, 7I, and C1 is B1I if there is no C2.
std::vector<ObservationType> observation_types_2(char system,
                                                 const std::vector<std::string>& names);

}  // namespace leonav
