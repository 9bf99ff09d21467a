// This unit writes ANTEX antenna files.
#pragma once
#include <span>
#include <string>

#include "core/gnss/propagation/antenna_model.h"

namespace leonav::sim {

// Writes one antenna for each satellite, whose patterns are consecutive, and one for the receiver.
//
// Source: ANTEX 1.4. `receiver_name` is type and radome, 20 characters. Offsets and variations are
// in 0.01 mm; variations by azimuth are written as their mean. The validity is not written: always.
// Throws FileError.
void write_antex(const std::string& path, std::span<const AntennaPattern> patterns,
                 const std::string& receiver_name);

}  // namespace leonav::sim
